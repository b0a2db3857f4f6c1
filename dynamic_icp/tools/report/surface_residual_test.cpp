// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/surface_residual.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::report {
namespace {

/// Points of the plane n . p = d within 10 m of its middle.
std::vector<Eigen::Vector3d> plane_points(const Eigen::Vector3d& n, double d, std::size_t count) {
  std::mt19937 random(11);
  const auto uniform = [&] { return 20.0 * (static_cast<double>(random()) / 4294967296.0) - 10.0; };
  const Eigen::Vector3d u = n.unitOrthogonal();
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(d * n + uniform() * u + uniform() * n.cross(u));
  }
  return points;
}

TEST(SurfaceResidual, IsTheDistanceToThePlane) {
  const Workers workers(2);
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  const double d = 12.0;
  const registration::PreparedTarget surface = surface_of(plane_points(n, d, 4000), workers);
  Vector6d xi;
  xi << 0.1, -0.3, 0.5, 2.0, -1.0, 0.4;
  const Eigen::Isometry3d T_surface_point = exp_se3(xi);
  std::vector<Eigen::Vector3d> points;
  std::vector<double> expected;
  for (double offset : {0.0, 0.01, -0.02, 0.3, -0.5}) {
    const Eigen::Vector3d p = d * n + 3.0 * n.unitOrthogonal() + offset * n;
    points.emplace_back(T_surface_point.inverse() * p);
    expected.push_back(std::abs(n.dot(p) - d));
  }
  points.emplace_back(T_surface_point.inverse() * Eigen::Vector3d(d * n + 1.5 * n));  // nothing near
  points.emplace_back(T_surface_point.inverse() * Eigen::Vector3d(d * n + 40.0 * n.unitOrthogonal()));
  const std::vector<double> residual = surface_residual(surface, points, T_surface_point, workers);
  ASSERT_EQ(residual.size(), 7u);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(residual[i], expected[i], 1e-9) << i;
  }
  EXPECT_TRUE(std::isnan(residual[5]));
  EXPECT_TRUE(std::isnan(residual[6]));
}

TEST(SurfaceResidual, PointsThatAreNoPlaneHaveNoSurface) {
  const Workers workers(1);
  const registration::PreparedTarget two =
      surface_of(std::vector<Eigen::Vector3d>{{1.0, 0.0, 0.0}, {1.5, 0.0, 0.0}}, workers);
  const std::vector<Eigen::Vector3d> query = {{1.1, 0.0, 0.0}};
  EXPECT_TRUE(std::isnan(surface_residual(two, query, Eigen::Isometry3d::Identity(), workers)[0]));
  const registration::PreparedTarget none = surface_of({}, workers);
  EXPECT_TRUE(std::isnan(surface_residual(none, query, Eigen::Isometry3d::Identity(), workers)[0]));
}

}  // namespace
}  // namespace dynamic_icp::report
