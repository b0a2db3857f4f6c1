// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/association.hpp"

#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

/// Poses at x = t for the given times in milliseconds, turned by t radians about z.
Trajectory at_times_ms(const std::vector<std::int64_t>& times_ms) {
  Trajectory trajectory;
  for (const std::int64_t ms : times_ms) {
    const double t = static_cast<double>(ms) * 1e-3;
    trajectory.push_back({{ms * 1'000'000}, Eigen::Isometry3d::Identity()});
    trajectory.back().T_world_sensor.linear() = exp_so3({0.0, 0.0, t});
    trajectory.back().T_world_sensor.translation().x() = t;
  }
  return trajectory;
}

std::string message_of(const Trajectory& estimate, const Trajectory& reference) {
  try {
    associate(estimate, reference);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const Trajectory& estimate, const Trajectory& reference, const std::string& expected) {
  const std::string message = message_of(estimate, reference);
  EXPECT_NE(message.find(expected), std::string::npos) << message;
}

TEST(Association, EqualStampsMatchExactly) {
  std::mt19937 random(1);
  const Trajectory trajectory = random_drive(random, 20);
  const Association matched = associate(trajectory, trajectory);
  ASSERT_EQ(matched.size(), 20u);
  EXPECT_EQ(matched.exact_count, 20u);
  for (std::size_t k = 0; k < matched.size(); ++k) {
    EXPECT_EQ(matched.estimate_indices[k], k);
    EXPECT_EQ(matched.reference[k].stamp, trajectory[k].stamp);
    EXPECT_EQ(matched.reference[k].T_world_sensor.matrix(), trajectory[k].T_world_sensor.matrix());
  }
}

TEST(Association, InterpolatesPositionAndRotation) {
  const Association matched = associate(at_times_ms({30, 100, 170}), at_times_ms({0, 100, 200}));
  ASSERT_EQ(matched.size(), 3u);
  EXPECT_EQ(matched.exact_count, 1u);
  for (const formats::StampedPose& pose : matched.reference) {
    const double t = seconds_between({0}, pose.stamp);
    EXPECT_NEAR(pose.T_world_sensor.translation().x(), t, 1e-15);
    EXPECT_LT((pose.T_world_sensor.linear() - exp_so3({0.0, 0.0, t})).norm(), 1e-14);
  }
}

TEST(Association, RotationTakesTheShortArc) {
  Trajectory reference = at_times_ms({0, 100});
  reference[0].T_world_sensor.linear() = exp_so3({0.0, 0.0, -3.0});
  reference[1].T_world_sensor.linear() = exp_so3({0.0, 0.0, 3.0});
  const Association matched = associate(at_times_ms({50}), reference);
  EXPECT_LT((matched.reference[0].T_world_sensor.linear() - exp_so3({0.0, 0.0, std::numbers::pi})).norm(), 1e-12);
}

TEST(Association, NeverAcrossGapsNorBeyondTheEnds) {
  // The gap from 200 to 401 ms is longer than the 0.2 s allowed, the one from 401 to 601 ms is not.
  const Trajectory reference = at_times_ms({100, 200, 401, 601});
  const Association matched = associate(at_times_ms({50, 100, 150, 300, 401, 500, 601, 602}), reference);
  EXPECT_EQ(matched.estimate_indices, (std::vector<std::size_t>{1, 2, 4, 5, 6}));
  EXPECT_EQ(matched.estimate_count, 8u);
  EXPECT_EQ(matched.reference_count, 4u);
  EXPECT_EQ(matched.exact_count, 3u);
  EXPECT_EQ(associate(at_times_ms({300}), reference, {0.201}).size(), 1u);
  EXPECT_EQ(associate(at_times_ms({100, 150}), reference, {0.0}).size(), 1u);
}

TEST(Association, StampsRoundedByADoubleStillMatch) {
  const Trajectory reference = at_times_ms({0, 1000, 2000});  // too far apart to interpolate
  Trajectory estimate = reference;
  estimate[0].stamp.ns -= 238;
  estimate[1].stamp.ns += 238;
  estimate[2].stamp.ns += 1001;
  const Association matched = associate(estimate, reference);
  EXPECT_EQ(matched.estimate_indices, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(matched.exact_count, 0u);
  EXPECT_EQ(matched.reference[1].T_world_sensor.translation().x(), 1.0);
}

TEST(Association, NoMatchSaysBothSpansAndAGuess) {
  const Trajectory estimate = at_times_ms({1000, 1100, 1200, 2000});
  expect_message(estimate, at_times_ms({5000, 5100, 5200, 6000}), "4 poses from 1.000000000 to 2.000000000 s");
  expect_message(estimate, at_times_ms({5000, 5100, 5200, 6000}), "4 poses from 5.000000000 to 6.000000000 s");
  expect_message(estimate, at_times_ms({5000, 5100, 5200, 6000}),
                 "the reference starts 4.000000000 s after the estimate");
  expect_message(estimate, at_times_ms({1'700'000'000'000, 1'700'000'001'000}), "Unix time");
  expect_message(estimate, at_times_ms({1'000'000, 2'000'000}), "differ by a factor of 1000)");
  expect_message(at_times_ms({1'000'000, 2'000'000}), estimate, "differ by a factor of 1000)");
  expect_message(estimate, at_times_ms({0, 900, 2100}), "at most 0.2 s apart");
}

TEST(Association, RefusesBrokenTrajectories) {
  const Trajectory good = at_times_ms({0, 100});
  expect_message({}, good, "the estimate has no poses");
  expect_message(good, {}, "the reference has no poses");
  Trajectory bad = good;
  bad[1].T_world_sensor.translation().z() = std::numeric_limits<double>::quiet_NaN();
  expect_message(bad, good, "pose 1 of the estimate (at 0.100000000 s) is not finite");
  bad = good;
  bad[1].stamp = bad[0].stamp;
  expect_message(good, bad, "pose 1 of the reference");
  EXPECT_THROW(associate(good, good, {-1.0}), UsageError);
  EXPECT_THROW(associate(good, good, {std::numeric_limits<double>::quiet_NaN()}), UsageError);
}

TEST(Association, PathDistancesAddUp) {
  EXPECT_TRUE(path_distances({}).empty());
  EXPECT_EQ(path_distances(along_x({5.0, 6.0, 6.0, 4.0})), (std::vector<double>{0.0, 1.0, 1.0, 3.0}));
}

}  // namespace
}  // namespace dynamic_icp::evaluation
