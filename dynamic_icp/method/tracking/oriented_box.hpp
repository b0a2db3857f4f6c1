// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// A box that stands on the ground: its third axis is up.
struct OrientedBox {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< m
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: unit vectors along length, width and height
  Eigen::Vector3d size = Eigen::Vector3d::Zero();      ///< m, length, width, height
};

/// The axes of a body that points to `yaw_rad` from the x axis in the plane of x and y.
Eigen::Matrix3d upright_axes(double yaw_rad);

/// How far outside of the box the point is, m; 0 inside.
double distance_outside(const OrientedBox& box, const Eigen::Vector3d& point);

/// Size along the axes of the frame of the smallest box that holds the oriented one.
Eigen::Vector3d aligned_extent(const OrientedBox& box);

/// What some points span along an axis.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// The span of (p - origin) . axis without the outermost `trim` of the points (a share, 0 to 0.5) on either side, so
/// that a stray point does not move it. Zero for no points.
Interval span_along(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                    double trim);

/// The direction of the sides of a body with a rectangular outline, seen from above: the yaw in
/// [near_yaw - range, near_yaw + range] for which most points lie close to an edge of the rectangle around them
/// (closeness criterion of Zhang et al., L-shape fitting, IV 2017). Sides have no front: the result is known up to
/// quarter turns. Nothing for fewer than five points.
std::optional<double> fit_yaw(std::span<const Eigen::Vector3d> points, double near_yaw_rad, double range_rad);

}  // namespace dynamic_icp::tracking
