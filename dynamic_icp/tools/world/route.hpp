// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::world {

/// A stretch of road whose curvature (1/m, positive to the left) changes linearly with the way: a straight, an arc or
/// a clothoid between them.
struct RoutePiece {
  double length_m = 0.0;
  double curvature_begin = 0.0;
  double curvature_end = 0.0;
};

/// A turn by `angle_rad` (positive to the left) with clothoids of `ramp_m` at both ends, so that the yaw rate has no
/// steps. Requires |angle_rad| * radius_m >= ramp_m.
std::vector<RoutePiece> turn(double angle_rad, double radius_m, double ramp_m);

/// A point of a route.
struct RoutePoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double heading_rad = 0.0;                            ///< of the tangent, from x to y
  double curvature = 0.0;                              ///< 1/m
};

/// A smooth line in the plane, parametrised by its arc length. Position, heading and curvature belong together to
/// better than 1e-9: heading is the closed-form integral of the curvature, position the quadrature of the heading.
/// Beyond both ends the route continues straight.
class Route {
 public:
  /// From `start`, heading in direction `heading_rad`. Lengths must be positive.
  explicit Route(const std::vector<RoutePiece>& pieces, const Eigen::Vector2d& start = Eigen::Vector2d::Zero(),
                 double heading_rad = 0.0);

  [[nodiscard]] double length_m() const { return knots_.back().s; }

  [[nodiscard]] RoutePoint at(double s_m) const;

 private:
  struct Knot {
    double s = 0.0;
    RoutePoint point;
    double curvature_slope = 0.0;  // 1/m^2, up to the next knot
  };

  static RoutePoint advance(const Knot& knot, double ds);

  std::vector<Knot> knots_;
};

}  // namespace dynamic_icp::world
