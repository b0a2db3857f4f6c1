// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/detection.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

/// Where spans of points end: this share of the points at either end is left out.
constexpr double kViewTrim = 0.01;

/// Where the points along one axis of a box end.
struct EndView {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< m, world: of the points there, of the nearer part of them ...
  double inside = 0.0;                               ///< m: ... which is so far within the end
  double count = 0.0;                                ///< of the points there ...
  bool is_of_few = false;                            ///< ... so few that they may be somebody else's
  double gap = 0.0;                                  ///< m, from the end to the next points
  double lowest = 0.0;                               ///< m, up from the reference: of these points
  double reach = 0.0;                                ///< m, of the few points beyond the end, but for one
  double width = 0.0;                                ///< m, across the axis, of what is seen at the end
  double depth = 0.0;                                ///< m, along the axis: of these points, root mean square
  bool has_points_beyond = false;                    ///< far from it, few: seen over something nearer
  bool is_true = false;                              ///< whether the body ends there, too ...
  double hidden = 0.0;  ///< m: ... or if > 0 its upper part, and below so much farther in the mean
  bool is_cut = false;  ///< of the top: by the upper edge of the field of view
};

/// What a detection shows along one axis of a box.
struct AxisView {
  Interval seen;  ///< m, from the reference
  EndView low;
  EndView high;
};

/// What the points of a detection (m, world, at its mean time; at least one) show along the `axes` of a box about a
/// reference point of the body. How far a body reaches away from the sensor shows only a face that looks at the sensor
/// and spans that axis; and an end is one of the body only where nothing hides what would follow. `W` as in
/// ClusterVelocity tells where points of the body may be missing because they hardly move along the line of sight.
/// `top_m`: how far the body reaches up from the reference, where that is known.
std::array<AxisView, 3> views_along(const Eigen::Matrix3d& axes, const Eigen::Vector3d& reference,
                                    std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& W,
                                    const Detection& detection, std::optional<double> top_m = {});

}  // namespace dynamic_icp::tracking
