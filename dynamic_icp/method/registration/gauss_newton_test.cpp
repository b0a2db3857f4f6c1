// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/gauss_newton.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::registration {
namespace {

// Pairs at the start and none anywhere else, so that the first step loses all.
class LosingProblem : public Problem {
 public:
  Correspondences find(const Eigen::Isometry3d& T) override {
    const std::size_t pairs = T.matrix().isIdentity() ? 10 : 0;
    return evaluated(std::vector<Correspondence>(pairs, {0, 0, 0.01}), 10);
  }
  [[nodiscard]] Linearisation linearise(const Correspondences& /*pairs*/, const Eigen::Isometry3d& /*T*/,
                                        int /*iteration*/) const override {
    Linearisation result;
    result.equations.H.setIdentity();
    result.equations.b.setConstant(-1.0);
    return result;
  }
};

TEST(GaussNewton, AStepThatLosesAllPairsIsNoAlignment) {
  LosingProblem problem;
  StopRule stop;
  stop.max_iterations = 1;
  const Alignment result = minimise(problem, Eigen::Isometry3d::Identity(), 1.0, stop);
  ASSERT_EQ(result.correspondences, 0U);
  EXPECT_EQ(result.status, AlignStatus::kTooFewCorrespondences);
}

// Two points of the same place whose gradients leave the range of double.
class RunawayProblem : public Problem {
 public:
  explicit RunawayProblem(double gradient) : gradient_(gradient) {}
  Correspondences find(const Eigen::Isometry3d& T) override {
    EXPECT_TRUE(T.matrix().allFinite());
    return evaluated(std::vector<Correspondence>(10, {0, 0, 0.01}), 10);
  }
  [[nodiscard]] Linearisation linearise(const Correspondences& /*pairs*/, const Eigen::Isometry3d& /*T*/,
                                        int iteration) const override {
    Linearisation result;
    result.equations.H.setIdentity();
    result.equations.b.setConstant(iteration == 0 ? -0.01 : gradient_);
    return result;
  }

 private:
  double gradient_;
};

TEST(GaussNewton, AStepOutOfReachEndsAtThePoseBeforeIt) {
  for (const double gradient : {1e7, 1e200, std::numeric_limits<double>::infinity()}) {
    RunawayProblem problem(gradient);
    const Alignment result = minimise(problem, Eigen::Isometry3d::Identity(), 1.0, {});
    EXPECT_EQ(result.status, AlignStatus::kDiverged) << gradient;
    EXPECT_FALSE(result.covariance);
    EXPECT_TRUE(result.T_target_source.matrix().allFinite());
    EXPECT_NEAR(result.T_target_source.translation().norm(), 0.01 * std::sqrt(3.0), 1e-3);
  }
}

}  // namespace
}  // namespace dynamic_icp::registration
