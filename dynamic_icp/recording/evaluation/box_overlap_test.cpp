// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/box_overlap.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

Box box(const Vector3d& center, const Vector3d& size, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  Box result;
  result.T_sensor_box = Eigen::Translation3d(center) * q;
  result.size = size;
  return result;
}

TEST(BoxOverlap, OfBoxesAlongTheSameAxes) {
  const Box car = box({10, 0, 0}, {4, 2, 1.5});
  EXPECT_NEAR(common_volume(car, car), 12.0, 1e-9);
  EXPECT_NEAR(intersection_over_union(car, car), 1.0, 1e-9);
  const Box ahead = box({12, 0.5, 0}, {4, 2, 1.5});
  EXPECT_NEAR(common_volume(car, ahead), 2.0 * 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(intersection_over_union(car, ahead), 4.5 / 19.5, 1e-9);
  EXPECT_NEAR(common_volume(car, box({10, 0, 0}, {1, 1, 1})), 1.0, 1e-9) << "one within the other";
  EXPECT_EQ(common_volume(car, box({14.5, 0, 0}, {4, 2, 1.5})), 0.0);
  EXPECT_NEAR(common_volume(car, box({14, 0, 0}, {4, 2, 1.5})), 0.0, 1e-9) << "they touch";
  EXPECT_EQ(intersection_over_union(car, box({10, 0, 0}, {4, 2, 0})), 0.0);
}

TEST(BoxOverlap, OfATurnedBox) {
  // Two squares of edge 2, one turned by 45 degrees: a regular octagon of inradius 1.
  const Box square = box({0, 0, 0}, {2, 2, 1});
  const Box turned =
      box({0, 0, 0.25}, {2, 2, 1}, Eigen::Quaterniond(AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ())));
  const double octagon = 8.0 * std::tan(std::numbers::pi / 8.0);
  EXPECT_NEAR(common_volume(square, turned), 0.75 * octagon, 1e-9);
}

/// By random points in one of them.
TEST(BoxOverlap, IsTheShareOfPointsInBoth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> half(-0.5, 0.5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 30; ++trial) {
    const auto any = [&] {
      const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
      return box(0.6 * Vector3d(normal(random), normal(random), normal(random)),
                 {2.0 + half(random), 1.5 + half(random), 1.0 + half(random)}, q.normalized());
    };
    const Box a = any();
    const Box b = any();
    constexpr int kPoints = 20000;
    int in_both = 0;
    for (int k = 0; k < kPoints; ++k) {
      const Vector3d in_a = Vector3d(half(random), half(random), half(random)).cwiseProduct(a.size);
      const Vector3d in_b = b.T_sensor_box.inverse() * (a.T_sensor_box * in_a);
      in_both += (in_b.cwiseAbs().array() <= 0.5 * b.size.array()).all() ? 1 : 0;
    }
    const double share = static_cast<double>(in_both) / kPoints;
    const double sigma = std::sqrt(share * (1.0 - share) / kPoints) + 1e-4;
    EXPECT_NEAR(common_volume(a, b) / a.size.prod(), share, 4.5 * sigma) << trial;
    EXPECT_NEAR(common_volume(a, b), common_volume(b, a), 1e-9) << trial;
  }
}

}  // namespace
}  // namespace dynamic_icp::evaluation
