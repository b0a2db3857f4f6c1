// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// The sides of an upright box.
enum class Face { kFront, kRear, kLeft, kRight, kTop, kBottom };
inline constexpr std::array kFaces = {Face::kFront, Face::kRear, Face::kLeft, Face::kRight, Face::kTop, Face::kBottom};

/// The axis of the box (0 along, 1 to the left, 2 up) that a face is perpendicular to, and 1 or -1 where it looks along
/// or against it.
constexpr int axis_of(Face face) { return static_cast<int>(face) / 2; }
constexpr double side_of(Face face) { return static_cast<int>(face) % 2 == 0 ? 1.0 : -1.0; }

/// The faces at either end of an axis, and the place of a face in arrays by Face.
constexpr Face high_face(int axis) { return static_cast<Face>(2 * axis); }
constexpr Face low_face(int axis) { return static_cast<Face>(2 * axis + 1); }
constexpr std::size_t index_of(Face face) { return static_cast<std::size_t>(face); }

/// What is known of a face of a box.
enum class FaceView {
  kUnknown,  ///< never seen: where it is said to be is a guess from the other sides of the body
  kHidden,   ///< seen before, not in this scan: by something nearer, the body itself or the edge of the field of view
  kSeen,     ///< in this scan
};
constexpr FaceView last_of(FaceView /*any*/) { return FaceView::kSeen; }

/// A box that stands on the ground: its third axis is up.
struct OrientedBox {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< m
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: unit vectors along length, width and height
  Eigen::Vector3d size = Eigen::Vector3d::Zero();      ///< m, length, width, height
};

/// The axes of a body that points to `yaw_rad` from the x axis in the plane of x and y. Multiply by level axes from the
/// left where another plane is level.
Eigen::Matrix3d upright_axes(double yaw_rad);

/// How far outside of the box the point is, m; 0 inside.
double distance_outside(const OrientedBox& box, const Eigen::Vector3d& point);

/// The space between two boxes.
struct Gap {
  double width = 0.0;                                ///< m; 0 where one reaches into the other
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< m
};

/// Of two boxes with one upward axis.
Gap gap_between(const OrientedBox& a, const OrientedBox& b);

/// Size of the smallest box along the axes of `a` that holds both.
Eigen::Vector3d size_with(const OrientedBox& a, const OrientedBox& b);

/// Size along the axes of the frame of the smallest box that holds the oriented one.
Eigen::Vector3d aligned_extent(const OrientedBox& box);

/// What some points span along an axis.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] double length() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// The span of some values without the outermost `trim` of them (a share, 0 to 0.5) on either side. Zero for none.
Interval span_of(std::span<const double> values, double trim);

/// The span of (p - origin) . axis without the outermost `trim` of the points (a share, 0 to 0.5) on either side, so
/// that a stray point does not move it. Zero for no points.
Interval span_along(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                    double trim);

/// The direction of the sides of a body with a rectangular outline, seen along the third of the `level` axes: the yaw
/// in [near_yaw - range, near_yaw + range] for which most points lie close to an edge of the rectangle around them
/// (closeness criterion of Zhang et al., L-shape fitting, IV 2017). Sides have no front: the result is known up to
/// quarter turns. Nothing for fewer than five points.
std::optional<double> fit_yaw(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& level,
                              double near_yaw_rad, double range_rad);

}  // namespace dynamic_icp::tracking
