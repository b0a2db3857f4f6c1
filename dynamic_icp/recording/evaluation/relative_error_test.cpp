// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/relative_error.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<std::pair<std::size_t, std::size_t>> ends_of(const RelativeError& error) {
  std::vector<std::pair<std::size_t, std::size_t>> ends;
  for (const RelativeStep& step : error.steps) {
    ends.emplace_back(step.from, step.to);
  }
  return ends;
}

TEST(RelativeError, EqualTrajectoriesHaveNone) {
  std::mt19937 random(1);
  const Trajectory trajectory = random_drive(random, 50);
  const RelativeError error = relative_error(associate(trajectory, trajectory));
  EXPECT_EQ(error.steps.size(), 49u);
  EXPECT_LT(error.translation_m->max, 1e-13);
  EXPECT_LT(error.rotation_deg->max, 1e-12);
}

TEST(RelativeError, ByHand) {
  // True: 1 m ahead and 90 degrees to the left. Estimated: 1.3 m ahead, 0.4 m to the left, 80 degrees.
  Trajectory reference = along_x({0.0, 1.0});
  Trajectory estimate = along_x({0.0, 1.3});
  reference[1].T_world_sensor.linear() = exp_so3({0.0, 0.0, 90.0 * kDegree});
  estimate[1].T_world_sensor.linear() = exp_so3({0.0, 0.0, 80.0 * kDegree});
  estimate[1].T_world_sensor.translation().y() = 0.4;
  const RelativeError error = relative_error(associate(estimate, reference));
  ASSERT_EQ(error.steps.size(), 1u);
  EXPECT_NEAR(error.steps[0].error.translation_m, 0.5, 1e-15);
  EXPECT_NEAR(error.steps[0].error.rotation_deg, 10.0, 1e-12);
}

TEST(RelativeError, FollowsTheDefinition) {
  std::mt19937 random(2);
  const Trajectory reference = random_drive(random, 30);
  const Trajectory estimate = disturbed(random, reference, 0.3, 0.5);
  const RelativeError error = relative_error(associate(estimate, reference), {GapUnit::kFrames, 3.0});
  ASSERT_EQ(error.steps.size(), 27u);
  double squares = 0.0;
  for (std::size_t k = 0; k < 27; ++k) {
    const Eigen::Matrix4d A = reference[k].T_world_sensor.matrix().inverse() * reference[k + 3].T_world_sensor.matrix();
    const Eigen::Matrix4d B = estimate[k].T_world_sensor.matrix().inverse() * estimate[k + 3].T_world_sensor.matrix();
    const Eigen::Matrix4d E = A.inverse() * B;
    const double cosine = (E.topLeftCorner<3, 3>().trace() - 1.0) / 2.0;
    EXPECT_NEAR(error.steps[k].error.translation_m, (E.topRightCorner<3, 1>().norm()), 1e-12);
    EXPECT_NEAR(error.steps[k].error.rotation_deg, std::acos(cosine) / kDegree, 1e-6);
    squares += E.topRightCorner<3, 1>().squaredNorm();
  }
  EXPECT_NEAR(error.translation_m->rmse, std::sqrt(squares / 27.0), 1e-12);
}

TEST(RelativeError, DoesNotDependOnTheWorldFrames) {
  std::mt19937 random(3);
  const Trajectory reference = random_drive(random, 40);
  const Trajectory estimate = disturbed(random, reference, 0.01, 0.05);
  const RelativeError before = relative_error(associate(estimate, reference));
  const RelativeError after = relative_error(
      associate(moved(estimate, random_motion(random, 3.0, 100.0)), moved(reference, random_motion(random, 3.0, 1e6))));
  for (std::size_t k = 0; k < before.steps.size(); ++k) {
    EXPECT_NEAR(after.steps[k].error.translation_m, before.steps[k].error.translation_m, 2e-9);
    EXPECT_NEAR(after.steps[k].error.rotation_deg, before.steps[k].error.rotation_deg, 1e-12);
  }
}

TEST(RelativeError, ShortRunsHaveNoStep) {
  const Trajectory one = along_x({1.0});
  const RelativeError error = relative_error(associate(one, one));
  EXPECT_TRUE(error.steps.empty());
  EXPECT_FALSE(error.translation_m);
  EXPECT_FALSE(error.rotation_deg);
  const Trajectory two = along_x({1.0, 2.0});
  EXPECT_EQ(relative_error(associate(two, two)).steps.size(), 1u);
  EXPECT_FALSE(relative_error(associate(two, two), {GapUnit::kFrames, 2.0}).translation_m);
}

TEST(RelativeError, FramesAreExact) {
  const Trajectory trajectory = along_x(std::vector<double>(25, 0.0));
  const RelativeError error = relative_error(associate(trajectory, trajectory), {GapUnit::kFrames, 20.0});
  EXPECT_EQ(ends_of(error),
            (std::vector<std::pair<std::size_t, std::size_t>>{{0, 20}, {1, 21}, {2, 22}, {3, 23}, {4, 24}}));
}

TEST(RelativeError, SecondsFindTheNearestPose) {
  Trajectory trajectory = along_x({0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
  // Twelfths of a second, rounded: three steps are 249,999,999 ns.
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    trajectory[k].stamp.ns = static_cast<std::int64_t>(k) * 83'333'333;
  }
  const auto ends = [&](double seconds) {
    return ends_of(relative_error(associate(trajectory, trajectory), {GapUnit::kSeconds, seconds}));
  };
  EXPECT_EQ(ends(0.25), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 3}, {1, 4}, {2, 5}}));
  EXPECT_EQ(ends(0.24), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 3}, {1, 4}, {2, 5}}));
  // 0.26: the trajectory must go on for so long, then the pose 0.25 s later is the nearest.
  EXPECT_EQ(ends(0.26), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 3}, {1, 4}}));
  EXPECT_TRUE(ends(0.05).empty()) << "0.083 s is more than 10 % off";
  EXPECT_TRUE(ends(0.21).empty()) << "0.167 and 0.25 s are more than 10 % off";
  EXPECT_TRUE(ends(1.0).empty());
}

TEST(RelativeError, MetersAreMeasuredAlongTheReference) {
  const Trajectory reference = along_x({0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 2.0, 10.0});
  const Trajectory estimate = along_x({0.0, 5.0, 10.0, 10.0, 10.0, 15.0, 10.0, 50.0});
  // Distances 0 1 2 2 2 3 4 12: of those that are equally near, the first to arrive.
  const RelativeError error = relative_error(associate(estimate, reference), {GapUnit::kMeters, 2.0});
  EXPECT_EQ(ends_of(error), (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 5}, {2, 6}, {3, 6}, {4, 6}}));
  EXPECT_NEAR(error.steps[0].error.translation_m, 8.0, 1e-12);
}

TEST(RelativeError, CountsStepsOverUnmatchedPoses) {
  const Trajectory estimate = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  Trajectory reference = estimate;
  reference.erase(reference.begin() + 2);
  const Association matched = associate(estimate, reference, {0.0});
  const RelativeError error = relative_error(matched);
  EXPECT_EQ(error.steps.size(), 3u);
  EXPECT_EQ(error.steps_over_unmatched, 1u);
}

TEST(RelativeError, RefusesImpossibleGaps) {
  const Trajectory two = along_x({1.0, 2.0});
  const Association matched = associate(two, two);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const RelativeGap& gap : {RelativeGap{GapUnit::kFrames, 0.0}, RelativeGap{GapUnit::kFrames, 1.5},
                                 RelativeGap{GapUnit::kFrames, nan}, RelativeGap{GapUnit::kSeconds, -1.0},
                                 RelativeGap{GapUnit::kMeters, nan}, RelativeGap{GapUnit::kMeters, 1e300}}) {
    EXPECT_THROW(relative_error(matched, gap), UsageError) << gap.length;
  }
}

}  // namespace
}  // namespace dynamic_icp::evaluation
