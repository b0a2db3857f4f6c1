// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dynamic_icp::world {
namespace {

// Between two knots the heading changes little enough for Gauss' formula of order 10 to be exact to rounding.
constexpr double kKnotSpacing = 2.0;  // m

Eigen::Vector2d unit(double heading) { return {std::cos(heading), std::sin(heading)}; }

}  // namespace

std::vector<RoutePiece> turn(double angle_rad, double radius_m, double ramp_m) {
  const double curvature = std::copysign(1.0 / radius_m, angle_rad);
  // Each ramp turns by half of what an arc of its length does.
  const double arc = std::abs(angle_rad) * radius_m - ramp_m;
  std::vector<RoutePiece> pieces = {{ramp_m, 0.0, curvature}};
  if (arc > 0.0) {
    pieces.push_back({arc, curvature, curvature});
  }
  pieces.push_back({ramp_m, curvature, 0.0});
  return pieces;
}

Route::Route(const std::vector<RoutePiece>& pieces, const Eigen::Vector2d& start, double heading_rad) {
  Knot knot;
  knot.point.position = start;
  knot.point.heading_rad = heading_rad;
  for (const RoutePiece& piece : pieces) {
    const int steps = static_cast<int>(std::ceil(piece.length_m / kKnotSpacing));
    const double ds = piece.length_m / steps;
    knot.point.curvature = piece.curvature_begin;
    knot.curvature_slope = (piece.curvature_end - piece.curvature_begin) / piece.length_m;
    for (int step = 0; step < steps; ++step) {
      knots_.push_back(knot);
      knot.point = advance(knot, ds);
      knot.s += ds;
    }
  }
  knot.point.curvature = 0.0;
  knot.curvature_slope = 0.0;
  knots_.push_back(knot);
}

RoutePoint Route::at(double s_m) const {
  if (s_m < 0.0) {
    RoutePoint before = knots_.front().point;
    before.position += s_m * unit(before.heading_rad);
    before.curvature = 0.0;
    return before;
  }
  const auto next =
      std::upper_bound(knots_.begin(), knots_.end(), s_m, [](double s, const Knot& knot) { return s < knot.s; });
  const Knot& knot = *std::prev(next);
  return advance(knot, s_m - knot.s);
}

RoutePoint Route::advance(const Knot& knot, double ds) {
  const auto heading_after = [&](double x) {
    return knot.point.heading_rad + x * (knot.point.curvature + 0.5 * x * knot.curvature_slope);
  };
  // Nodes and weights of Gauss and Legendre on [-1, 1].
  constexpr std::array<double, 5> kNodes = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                            0.906179845938664};
  constexpr std::array<double, 5> kWeights = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                              0.478628670499366, 0.236926885056189};
  RoutePoint point = knot.point;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    point.position += 0.5 * ds * kWeights[i] * unit(heading_after(0.5 * ds * (1.0 + kNodes[i])));
  }
  point.heading_rad = heading_after(ds);
  point.curvature = knot.point.curvature + ds * knot.curvature_slope;
  return point;
}

}  // namespace dynamic_icp::world
