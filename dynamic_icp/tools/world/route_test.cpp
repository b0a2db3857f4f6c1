// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/route.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::world {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

TEST(Route, WithoutPiecesIsAStraightLine) {
  const Route route({}, Vector2d(1.0, 2.0), 0.3);
  for (const double s : {-50.0, 0.0, 80.0}) {
    EXPECT_TRUE(route.at(s).position.isApprox(Vector2d(1.0 + s * std::cos(0.3), 2.0 + s * std::sin(0.3)), 1e-12));
    EXPECT_EQ(route.at(s).curvature, 0.0);
  }
}

TEST(Route, ArcIsACircle) {
  for (const double radius : {6.0, -6.0, 500.0}) {
    const Route route({{100.0, 1.0 / radius, 1.0 / radius}});
    for (double s = 0.0; s <= 100.0; s += 3.7) {
      const Vector2d expected(radius * std::sin(s / radius), radius * (1.0 - std::cos(s / radius)));
      EXPECT_LT((route.at(s).position - expected).norm(), 1e-9) << s;
      EXPECT_NEAR(route.at(s).heading_rad, s / radius, 1e-12);
    }
  }
}

TEST(Route, ClothoidAgreesWithFineQuadrature) {
  const Route route({{60.0, -0.02, 0.1}});
  Vector2d position = Vector2d::Zero();
  const int steps = 600'000;
  const double ds = 60.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) * ds;  // midpoint rule
    const double heading = -0.02 * s + 0.5 * 0.12 / 60.0 * s * s;
    position += ds * Vector2d(std::cos(heading), std::sin(heading));
  }
  EXPECT_LT((route.at(60.0).position - position).norm(), 1e-8);
}

TEST(Route, PositionHeadingAndCurvatureBelongTogether) {
  std::vector<RoutePiece> pieces = {{20.0, 0.0, 0.0}};
  for (const double angle : {0.5 * pi, -1.2}) {
    const auto bend = turn(angle, 12.0, 6.0);
    pieces.insert(pieces.end(), bend.begin(), bend.end());
  }
  const Route route(pieces);
  const double h = 1e-4;
  for (double s = -5.0; s < route.length_m() + 5.0; s += 0.313) {
    const RoutePoint point = route.at(s);
    const Vector2d slope = (route.at(s + h).position - route.at(s - h).position) / (2.0 * h);
    EXPECT_LT((slope - Vector2d(std::cos(point.heading_rad), std::sin(point.heading_rad))).norm(), 1e-8) << s;
    EXPECT_NEAR((route.at(s + h).heading_rad - route.at(s - h).heading_rad) / (2.0 * h), point.curvature, 2e-6) << s;
  }
}

TEST(Route, TurnTurnsByItsAngle) {
  for (const double angle : {0.5 * pi, -0.5 * pi, 4.0, 0.5}) {
    const Route route(turn(angle, 12.0, 6.0));
    EXPECT_NEAR(route.at(route.length_m()).heading_rad, angle, 1e-12);
    EXPECT_NEAR(route.at(0.5 * route.length_m()).curvature, std::copysign(1.0 / 12.0, angle), 1e-12);
    EXPECT_NEAR(route.at(route.length_m()).curvature, 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace dynamic_icp::world
