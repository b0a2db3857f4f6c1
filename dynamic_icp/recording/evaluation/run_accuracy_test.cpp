// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/run_accuracy.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

TEST(RunAccuracy, EmptyNumbersWhereNothingCanBeTold) {
  const RunAccuracy none = evaluate_run({}, along_x({0.0}));
  EXPECT_EQ(none.matched, 0u);
  EXPECT_FALSE(none.path_length_m);
  EXPECT_FALSE(none.ate_rmse_m);
  const RunAccuracy one = evaluate_run(along_x({0.0}), along_x({0.0, 1.0}));
  EXPECT_EQ(one.matched, 1u);
  EXPECT_EQ(one.path_length_m, 0.0);
  EXPECT_FALSE(one.rte_rmse_m);
  EXPECT_FALSE(one.rre_median_deg);
  EXPECT_FALSE(one.ate_rmse_m);
  const RunAccuracy astray = evaluate_run(along_x({0.0, 1e200}), along_x({0.0, 1.0}));
  EXPECT_FALSE(astray.rte_rmse_m);
  EXPECT_FALSE(astray.ate_rmse_m);
  EXPECT_EQ(astray.rre_rmse_deg, 0.0);
}

TEST(RunAccuracy, TwoPosesByHand) {
  const RunAccuracy two = evaluate_run(along_x({0.0, 1.0}), along_x({5.0, 7.0}));
  EXPECT_EQ(two.matched, 2u);
  EXPECT_NEAR(*two.rte_rmse_m, 1.0, 1e-15);
  EXPECT_NEAR(*two.ate_rmse_m, 0.5, 1e-15);
  EXPECT_EQ(two.path_length_m, 2.0);
}

TEST(RunAccuracy, ByHand) {
  // Steps are wrong by 0.1, 0.2 and 0.6 m; the last also by 30 degrees.
  formats::Trajectory estimate = along_x({0.0, 1.1, 2.3, 3.9});
  estimate[3].T_world_sensor.linear() = exp_so3({0.0, std::acos(-1.0) / 6.0, 0.0});
  const RunAccuracy run = evaluate_run(estimate, along_x({0.0, 1.0, 2.0, 3.0}));
  EXPECT_NEAR(*run.rte_rmse_m, std::sqrt(0.41 / 3.0), 1e-12);
  EXPECT_NEAR(*run.rte_mean_m, 0.3, 1e-12);
  EXPECT_NEAR(*run.rte_median_m, 0.2, 1e-12);
  EXPECT_NEAR(*run.rre_rmse_deg, 30.0 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(*run.rre_mean_deg, 10.0, 1e-12);
  EXPECT_NEAR(*run.rre_median_deg, 0.0, 1e-12);
  // On a line the alignment only shifts: what is left are the deviations of 0, 0.1, 0.3, 0.9 from their mean.
  EXPECT_NEAR(*run.ate_rmse_m, std::sqrt(0.91 / 4.0 - 0.325 * 0.325), 1e-12);
}

TEST(RunAccuracy, ForeignReferencesAreAnError) {
  formats::Trajectory later = along_x({0.0, 1.0});
  for (formats::StampedPose& pose : later) {
    pose.stamp.ns += 1'000'000'000'000;
  }
  EXPECT_THROW(evaluate_run(along_x({0.0, 1.0}), later), DataError);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
