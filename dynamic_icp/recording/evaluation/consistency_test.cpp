// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/consistency.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

/// Errors e of the motions with e ~ N(0, C), a covariance with correlations of its own for each, and what is stated.
struct Draw {
  Trajectory estimate;
  std::vector<StatedMotion> stated;
};

/// T_target_source = exp(-e) T_true, written with plain matrices.
Draw draw(const Trajectory& truth, double stated_over_true, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Draw result{{truth.front()}, {{std::nullopt, true, false}}};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    Matrix6d L = Matrix6d::Identity();
    Vector6d z;
    for (Eigen::Index r = 0; r < 6; ++r) {
      z[r] = normal(random);
      for (Eigen::Index c = 0; c < r; ++c) {
        L(r, c) = normal(random);
      }
    }
    Vector6d sigma;
    sigma << 1e-3, 2e-3, 5e-4, 0.01, 0.03, 0.002;
    L = sigma.asDiagonal() * L;
    const Eigen::Matrix4d T_true = truth[k].T_world_sensor.matrix().inverse() * truth[k - 1].T_world_sensor.matrix();
    const Eigen::Matrix4d T_target_source = exp_se3(-(L * z)).matrix() * T_true;
    const Eigen::Isometry3d T_world_target(result.estimate.back().T_world_sensor.matrix() * T_target_source.inverse());
    result.estimate.push_back({truth[k].stamp, T_world_target});
    result.stated.push_back({stated_over_true * stated_over_true * L * L.transpose(), true, false});
  }
  return result;
}

TEST(Consistency, OfErrorsDrawnFromTheStatedCovarianceIsThree) {
  std::mt19937 random(5);
  const Trajectory truth = random_drive(random, 4001);
  const Draw right = draw(truth, 1.0, random);
  const Consistency found = consistency(associate(right.estimate, truth), right.stated);
  EXPECT_EQ(found.motions, 4000U);
  EXPECT_NEAR(*found.nees_rotation, 3.0, 0.2);  // its standard deviation is sqrt(6 / 4000) = 0.04
  EXPECT_NEAR(*found.nees_translation, 3.0, 0.2);
  EXPECT_LT(*found.beyond_4_sigma, 0.002);
}

TEST(Consistency, FindsOverconfidence) {
  std::mt19937 random(6);
  const Trajectory truth = random_drive(random, 4001);
  const Draw half = draw(truth, 0.5, random);
  const Consistency found = consistency(associate(half.estimate, truth), half.stated);
  EXPECT_NEAR(*found.nees_rotation, 12.0, 0.8);
  EXPECT_NEAR(*found.nees_translation, 12.0, 0.8);
  // Beyond two true sigma lie 4.55 % on each axis: more than on one, less than on six that are independent.
  EXPECT_GT(*found.beyond_4_sigma, 0.06);
  EXPECT_LT(*found.beyond_4_sigma, 1.0 - std::pow(1.0 - 0.0455, 6));
}

/// Truth: 1 m along x of the world with a turn to the left by 90 degrees. The estimate is `off` m too far along x,
/// which is -y of the sensor there, and has turned 0.1 rad too little: T_true T_estimate^-1 = [Rz(-0.1), (0, -off, 0)].
Association off_along_y(double off) {
  Trajectory truth = along_x({0.0, 1.0});
  truth[1].T_world_sensor.linear() = exp_so3({0.0, 0.0, 0.5 * std::numbers::pi});
  Trajectory estimate = truth;
  estimate[1].T_world_sensor.translation().x() += off;
  estimate[1].T_world_sensor.linear() = exp_so3({0.0, 0.0, 0.5 * std::numbers::pi - 0.1});
  return associate(estimate, truth);
}

TEST(Consistency, ErrorsAreInTheAxesOfTheFrame) {
  Matrix6d covariance = Matrix6d::Identity();
  covariance(2, 2) = 0.01 / 4.0;  // 0.1 rad are two sigma
  covariance(4, 4) = 0.01;
  std::vector<StatedMotion> stated = {{}, {covariance, true, false}};
  const Consistency near = consistency(off_along_y(0.3), stated);
  EXPECT_EQ(near.motions, 1U);
  EXPECT_NEAR(*near.nees_rotation, 4.0, 1e-9);
  EXPECT_NEAR(*near.nees_translation, 9.0, 0.1) << "log bends the translation a little";
  EXPECT_EQ(near.beyond_4_sigma, 0.0);
  EXPECT_EQ(consistency(off_along_y(0.5), stated).beyond_4_sigma, 1.0);
  stated[1].ok = false;
  const Consistency not_ok = consistency(off_along_y(0.5), stated);
  EXPECT_EQ(not_ok.motions, 1U);
  EXPECT_FALSE(not_ok.beyond_4_sigma) << "a run that says it is lost claims nothing";
}

TEST(Consistency, OnlyMotionsBetweenFramesThatFollowEachOtherCount) {
  const Trajectory truth = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  std::vector<StatedMotion> stated(5, {Matrix6d::Identity(), true, false});
  EXPECT_EQ(consistency(associate(truth, truth), stated).motions, 4U);
  Trajectory gap = truth;
  gap.erase(gap.begin() + 2);
  EXPECT_EQ(consistency(associate(truth, gap, {0.0}), stated).motions, 2U);
  stated[1].skipped = true;
  EXPECT_EQ(consistency(associate(truth, truth), stated).motions, 3U);
  stated[3].covariance.reset();
  EXPECT_EQ(consistency(associate(truth, truth), stated).motions, 2U);
  const Consistency none = consistency(associate(truth, truth), std::vector<StatedMotion>(5));
  EXPECT_EQ(none.motions, 0U);
  EXPECT_FALSE(none.nees_rotation || none.nees_translation || none.beyond_4_sigma);
}

TEST(Consistency, CovariancesThatAreNoneHaveNoNees) {
  Matrix6d covariance = Matrix6d::Identity();
  covariance(4, 4) = -1.0;
  const Consistency found = consistency(off_along_y(0.0), std::vector<StatedMotion>{{}, {covariance, true, false}});
  EXPECT_TRUE(found.nees_rotation);
  EXPECT_FALSE(found.nees_translation);
  EXPECT_EQ(found.beyond_4_sigma, 1.0);
}

TEST(Consistency, NeedsAStatementForEachPose) {
  const Trajectory two = along_x({0.0, 1.0});
  EXPECT_THROW(consistency(associate(two, two), std::vector<StatedMotion>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
