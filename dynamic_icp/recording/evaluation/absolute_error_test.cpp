// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/absolute_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "testing/test_trajectories.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::Trajectory;

double sum_of_squares(const Association& matched, double scale, const Eigen::Isometry3d& T) {
  double sum = 0.0;
  for (std::size_t k = 0; k < matched.size(); ++k) {
    const Eigen::Vector3d aligned = scale * (T.linear() * matched.estimate[k].T_world_sensor.translation());
    sum += (matched.reference[k].T_world_sensor.translation() - aligned - T.translation()).squaredNorm();
  }
  return sum;
}

Eigen::Vector3d mean_position(const Trajectory& trajectory) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const formats::StampedPose& pose : trajectory) {
    sum += pose.T_world_sensor.translation();
  }
  return sum / static_cast<double>(trajectory.size());
}

TEST(AbsoluteError, WithoutAlignmentByHand) {
  const AbsoluteError error =
      absolute_error(associate(along_x({0.0, 1.5, 2.0}), along_x({0.0, 1.0, 4.0})), Alignment::kNone);
  EXPECT_EQ(error.errors_m, (std::vector<double>{0.0, 0.5, 2.0}));
  EXPECT_EQ(error.status, AlignmentStatus::kGiven);
  EXPECT_NEAR(error.translation_m->rmse, std::sqrt(4.25 / 3.0), 1e-15);
  EXPECT_EQ(error.translation_m->max, 2.0);
}

TEST(AbsoluteError, FirstMakesTheFirstPosesEqual) {
  std::mt19937 random(1);
  const Trajectory reference = random_drive(random, 30);
  Trajectory estimate = moved(reference, random_motion(random, 3.0, 100.0));
  EXPECT_LT(absolute_error(associate(estimate, reference), Alignment::kFirst).translation_m->max, 1e-11);
  estimate[10].T_world_sensor = estimate[10].T_world_sensor * Eigen::Translation3d(0.0, 0.7, 0.0);
  const AbsoluteError error = absolute_error(associate(estimate, reference), Alignment::kFirst);
  EXPECT_NEAR(error.errors_m[10], 0.7, 1e-11);
  EXPECT_NEAR(error.translation_m->mean, 0.7 / 30.0, 1e-11);
}

TEST(AbsoluteError, Se3RecoversTheMotion) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Trajectory reference = random_drive(random, 40);
    const Eigen::Isometry3d T = random_motion(random, 3.0, 200.0);
    const AbsoluteError error = absolute_error(associate(moved(reference, T.inverse()), reference));
    EXPECT_EQ(error.status, AlignmentStatus::kUnique);
    EXPECT_EQ(error.scale, 1.0);
    EXPECT_LT((error.T_reference_estimate.matrix() - T.matrix()).norm(), 1e-10);
    EXPECT_LT(error.translation_m->max, 1e-10);
  }
}

TEST(AbsoluteError, Sim3RecoversTheScale) {
  std::mt19937 random(3);
  for (const double scale : {0.01, 0.9, 3.0}) {
    const Trajectory reference = random_drive(random, 40);
    const Eigen::Isometry3d T = random_motion(random, 3.0, 20.0);
    const Association matched = associate(scaled(moved(reference, T), 1.0 / scale), reference);
    const AbsoluteError error = absolute_error(matched, Alignment::kSim3);
    EXPECT_NEAR(error.scale, scale, 1e-11);
    EXPECT_LT(error.translation_m->max, 1e-10);
    EXPECT_GT(absolute_error(matched, Alignment::kSe3).translation_m->rmse, 1.0);
  }
}

TEST(AbsoluteError, NothingNearbyIsBetter) {
  std::mt19937 random(4);
  const Trajectory reference = random_drive(random, 25);
  const Association matched = associate(disturbed(random, reference, 0.2, 1.0), reference);
  const AbsoluteError se3 = absolute_error(matched, Alignment::kSe3);
  const AbsoluteError sim3 = absolute_error(matched, Alignment::kSim3);
  EXPECT_LT(sim3.translation_m->rmse, se3.translation_m->rmse);
  for (const AbsoluteError& error : {se3, sim3}) {
    const double best = sum_of_squares(matched, error.scale, error.T_reference_estimate);
    EXPECT_NEAR(std::sqrt(best / 25.0), error.translation_m->rmse, 1e-12);
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Isometry3d T = random_motion(random, 1e-3, 1e-2) * error.T_reference_estimate;
      EXPECT_GT(sum_of_squares(matched, error.scale, T), best);
    }
  }
  const double best = sum_of_squares(matched, sim3.scale, sim3.T_reference_estimate);
  EXPECT_GT(sum_of_squares(matched, sim3.scale * 1.001, sim3.T_reference_estimate), best);
  EXPECT_GT(sum_of_squares(matched, sim3.scale * 0.999, sim3.T_reference_estimate), best);
}

TEST(AbsoluteError, NeverAReflection) {
  std::mt19937 random(5);
  const Trajectory reference = random_drive(random, 30);
  Trajectory mirrored = reference;
  for (formats::StampedPose& pose : mirrored) {
    pose.T_world_sensor.translation().x() *= -1.0;
  }
  const AbsoluteError error = absolute_error(associate(mirrored, reference));
  EXPECT_NEAR(error.T_reference_estimate.linear().determinant(), 1.0, 1e-12);
  EXPECT_GT(error.translation_m->rmse, 0.1);
  const Association matched = associate(mirrored, reference);
  const AbsoluteError sim3 = absolute_error(matched, Alignment::kSim3);
  for (const double factor : {0.999, 1.001}) {
    Eigen::Isometry3d T = sim3.T_reference_estimate;  // the best translation for another scale keeps the means equal
    T.translation() += (1.0 - factor) * sim3.scale * (T.linear() * mean_position(mirrored));
    EXPECT_GT(sum_of_squares(matched, factor * sim3.scale, T),
              sum_of_squares(matched, sim3.scale, sim3.T_reference_estimate));
  }
}

TEST(AbsoluteError, PlanarDrivesAreUnique) {
  Trajectory reference;
  for (int k = 0; k < 20; ++k) {
    reference.push_back({{k * kFrameNs}, Eigen::Isometry3d::Identity()});
    reference.back().T_world_sensor.translation() << k, 0.1 * k * k, 0.0;
  }
  std::mt19937 random(6);
  const Eigen::Isometry3d T = random_motion(random, 3.0, 10.0);
  const AbsoluteError error = absolute_error(associate(moved(reference, T.inverse()), reference));
  EXPECT_EQ(error.status, AlignmentStatus::kUnique);
  EXPECT_LT((error.T_reference_estimate.matrix() - T.matrix()).norm(), 1e-11);
}

TEST(AbsoluteError, StraightDrivesKeepTheRollOfTheFirstPose) {
  const Trajectory reference = along_x({0.0, 1.0, 3.0, 4.0});
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d T = random_motion(random, 3.0, 10.0);
    const AbsoluteError error = absolute_error(associate(moved(reference, T.inverse()), reference));
    EXPECT_EQ(error.status, AlignmentStatus::kLine);
    EXPECT_LT((error.T_reference_estimate.matrix() - T.matrix()).norm(), 1e-11);
    EXPECT_LT(error.translation_m->max, 1e-11);
  }
  // Driven the other way round by orientations that do not know: the line still decides.
  Trajectory backwards = reference;
  for (formats::StampedPose& pose : backwards) {
    pose.T_world_sensor.translation() *= -1.0;
  }
  const AbsoluteError error = absolute_error(associate(backwards, reference));
  EXPECT_LT(error.translation_m->max, 1e-14);
  EXPECT_NEAR(error.T_reference_estimate.linear().determinant(), 1.0, 1e-14);
}

TEST(AbsoluteError, StandingStillKeepsTheFirstOrientation) {
  std::mt19937 random(8);
  const Eigen::Isometry3d T = random_motion(random, 3.0, 10.0);
  const Trajectory still = along_x({2.0, 2.0, 2.0});
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kSim3}) {
    const AbsoluteError both = absolute_error(associate(moved(still, T.inverse()), still), alignment);
    EXPECT_EQ(both.status, AlignmentStatus::kPoint);
    EXPECT_EQ(both.scale, 1.0);
    EXPECT_LT((both.T_reference_estimate.matrix() - T.matrix()).norm(), 1e-12);
    EXPECT_LT(both.translation_m->max, 1e-12);
    // A moving estimate of a sensor that is static must not be shrunk to nothing.
    const AbsoluteError moving = absolute_error(associate(along_x({0.0, 3.0, 0.0}), still), alignment);
    EXPECT_EQ(moving.status, AlignmentStatus::kPoint);
    EXPECT_NEAR(moving.translation_m->rmse, std::sqrt(2.0), 1e-12);
    // Nor may rounding pass for motion.
    const AbsoluteError rounded =
        absolute_error(associate(along_x({0.0, 3.0, 0.0}), along_x({2.0, 2.0 - 1e-12, 2.0})), alignment);
    EXPECT_EQ(rounded.status, AlignmentStatus::kPoint);
    EXPECT_EQ(rounded.scale, 1.0);
    const AbsoluteError stuck = absolute_error(associate(still, along_x({0.0, 3.0, 0.0})), alignment);
    EXPECT_NEAR(stuck.translation_m->rmse, std::sqrt(2.0), 1e-12);
  }
}

TEST(AbsoluteError, ShortRuns) {
  const Trajectory one = along_x({1.0});
  const AbsoluteError alone = absolute_error(associate(one, along_x({3.0})));
  EXPECT_FALSE(alone.translation_m) << "the alignment leaves nothing to measure";
  EXPECT_NEAR(absolute_error(associate(one, along_x({3.0})), Alignment::kNone).translation_m->max, 2.0, 1e-15);
  // Two poses: the alignment meets in the middle.
  const AbsoluteError pair = absolute_error(associate(along_x({0.0, 1.0}), along_x({0.0, 2.0})));
  EXPECT_EQ(pair.status, AlignmentStatus::kLine);
  EXPECT_NEAR(pair.translation_m->rmse, 0.5, 1e-15);
  EXPECT_EQ(absolute_error(Association{}).status, AlignmentStatus::kNotRun);
}

TEST(AbsoluteError, LargeCoordinatesLoseNothing) {
  std::mt19937 random(9);
  Eigen::Isometry3d far = random_motion(random, 3.0, 1.0);
  far.translation() << 4e5, 4e6, 100.0;
  const Trajectory reference = random_drive(random, 30);
  const Trajectory estimate = disturbed(random, reference, 0.01, 0.1);
  const double near_rmse = absolute_error(associate(estimate, reference)).translation_m->rmse;
  const double far_rmse = absolute_error(associate(estimate, moved(reference, far))).translation_m->rmse;
  EXPECT_NEAR(far_rmse, near_rmse, 1e-8);
}

TEST(AbsoluteError, AstronomicPositionsHaveNoStatistic) {
  for (const Alignment alignment : {Alignment::kNone, Alignment::kFirst, Alignment::kSe3, Alignment::kSim3}) {
    const AbsoluteError error =
        absolute_error(associate(along_x({0.0, 1e200, 1.0}), along_x({0.0, 1.0, 2.0})), alignment);
    EXPECT_FALSE(error.translation_m);
    EXPECT_EQ(error.status, AlignmentStatus::kNotRun);
  }
}

}  // namespace
}  // namespace dynamic_icp::evaluation
