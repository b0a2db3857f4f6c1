// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/foliage.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::world {
namespace {

TEST(Foliage, VelocityIsTheDerivativeAndTheSizeIsTheOneAskedFor) {
  double squares = 0.0;
  int n = 0;
  for (double t = 0.0; t < 100.0; t += 0.037) {
    const Eigen::Vector3d position(3.0 + t, -2.0, 5.0);
    const LeafMotion motion = leaf_motion(position, t, 0.05);
    const double h = 1e-5;
    const Eigen::Vector3d slope =
        (leaf_motion(position, t + h, 0.05).displacement - leaf_motion(position, t - h, 0.05).displacement) / (2.0 * h);
    EXPECT_LT((motion.velocity - slope).norm(), 1e-7);
    squares += motion.displacement.squaredNorm();
    ++n;
  }
  EXPECT_NEAR(std::sqrt(2.0 * squares / n), 0.05, 0.003);
}

TEST(Foliage, NeighboursMoveAlikeAndFarLeavesDoNot) {
  const LeafMotion here = leaf_motion({10.0, 2.0, 4.0}, 1.3, 0.05);
  const LeafMotion beside = leaf_motion({10.05, 2.0, 4.0}, 1.3, 0.05);
  const LeafMotion far = leaf_motion({14.0, 2.0, 4.0}, 1.3, 0.05);
  EXPECT_LT((here.displacement - beside.displacement).norm(), 0.01);
  EXPECT_GT((here.displacement - far.displacement).norm(), 0.02);
}

}  // namespace
}  // namespace dynamic_icp::world
