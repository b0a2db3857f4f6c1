// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/segment_error.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

/// `count` poses along x, one every `step_m`.
Trajectory straight(std::size_t count, double step_m) {
  std::vector<double> xs;
  for (std::size_t k = 0; k < count; ++k) {
    xs.push_back(static_cast<double>(k) * step_m);
  }
  return along_x(xs);
}

TEST(SegmentError, ShortPathsHaveNoneInsteadOfNaN) {
  for (const std::size_t count : {1u, 2u, 50u, 101u}) {  // the longest is 100 m: not more than 100 m
    const Trajectory trajectory = straight(count, 1.0);
    const SegmentError error = segment_error(associate(trajectory, trajectory));
    EXPECT_EQ(error.all.count, 0u);
    EXPECT_FALSE(error.all.translation_percent);
    EXPECT_FALSE(error.all.rotation_deg_per_100m);
    ASSERT_EQ(error.lengths.size(), 8u);
    EXPECT_FALSE(error.lengths[0].mean.translation_percent);
  }
}

TEST(SegmentError, EqualTrajectoriesHaveZero) {
  const Trajectory trajectory = straight(102, 1.0);
  const SegmentError error = segment_error(associate(trajectory, trajectory));
  EXPECT_EQ(error.all.count, 1u);
  EXPECT_EQ(error.all.translation_percent, 0.0);
  EXPECT_EQ(error.all.rotation_deg_per_100m, 0.0);
}

TEST(SegmentError, ByHand) {
  // One pose a metre for 1000 m. The estimate is 1 % too long and turns by 0.02 degrees a pose, on the spot.
  const Trajectory reference = straight(1001, 1.0);
  Trajectory estimate = straight(1001, 1.01);
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    estimate[k].T_world_sensor.linear() =
        exp_so3({static_cast<double>(k) * 0.02 * std::numbers::pi / 180.0, 0.0, 0.0});  // about the line of travel
  }
  const SegmentError error = segment_error(associate(estimate, reference));
  double weighted_percent = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const SegmentLength& segment = error.lengths[k];
    // The end is the first pose beyond the length: one metre more. Starts 0, 10, ... as far as there is such an end.
    const double length = 100.0 * static_cast<double>(k + 1);
    EXPECT_EQ(segment.length_m, length);
    EXPECT_EQ(segment.mean.count, (999 - 100 * (k + 1)) / 10 + 1);
    EXPECT_NEAR(*segment.mean.translation_percent, (length + 1.0) * 0.01 / length * 100.0, 1e-9);
    EXPECT_NEAR(*segment.mean.rotation_deg_per_100m, (length + 1.0) * 0.02 / length * 100.0, 1e-9);
    weighted_percent += static_cast<double>(segment.mean.count) * *segment.mean.translation_percent;
    count += segment.mean.count;
  }
  EXPECT_EQ(error.all.count, count);
  EXPECT_NEAR(*error.all.translation_percent, weighted_percent / static_cast<double>(count), 1e-9);
}

TEST(SegmentError, LengthIsThatOfTheReference) {
  const Trajectory reference = straight(51, 3.0);  // 150 m
  const SegmentError error = segment_error(associate(straight(51, 30.0), reference));
  EXPECT_EQ(error.lengths[0].mean.count, 2u);  // from pose 0 to 34 (102 m), from pose 10 to 44
  EXPECT_EQ(error.lengths[1].mean.count, 0u);
  EXPECT_NEAR(*error.all.translation_percent, 34.0 * 27.0, 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
