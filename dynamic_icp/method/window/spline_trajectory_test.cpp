// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/spline_trajectory.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;

constexpr double kH = 0.0125;
constexpr double kBegin_s = 2.993;
constexpr double kUntil_s = 3.211;

Eigen::Isometry3d some_pose() {
  Vector6d xi;
  xi << 0.4, -0.2, 1.1, 12.0, -5.0, 2.0;
  return exp_se3(xi);
}

/// A vehicle that turns, brakes and sways.
Vector6d smooth_motion(double t) {
  Vector6d value;
  value << 0.02 * std::sin(9.0 * t), 0.5 * t * t, 0.3 * t + 0.01 * std::cos(12.0 * t), 10.0 * t - 3.0 * t * t,
      0.1 * std::sin(7.0 * t), 0.05 * std::cos(11.0 * t);
  return value;
}

SplineTrajectory smooth_trajectory() {
  SplineTrajectory trajectory(kH);
  trajectory.begin(kBegin_s, kUntil_s, some_pose(), Vector3d::Zero(), Vector3d::Zero());
  for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
    trajectory.coefficients()[k] = smooth_motion(kH * (static_cast<double>(k) - 2.0));
  }
  return trajectory;
}

/// Nothing smooth about it: every coefficient at random.
SplineTrajectory rough_trajectory() {
  SplineTrajectory trajectory = smooth_trajectory();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (Vector6d& c : trajectory.coefficients()) {
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      c[axis] = (axis < 3 ? 0.3 : 1.0) * uniform(random);
    }
  }
  return trajectory;
}

/// [phi; p] at a time, from the pose.
Vector6d value_at(const SplineTrajectory& trajectory, double time_s) {
  const Eigen::Isometry3d T = trajectory.reference().inverse() * trajectory.pose(time_s);
  Vector6d value;
  value << log_so3(T.linear()), T.translation();
  return value;
}

double weight_of(const SplineTrajectory& trajectory, std::size_t coefficient, double time_s) {
  const TrajectoryPoint point = trajectory.at(time_s);
  return coefficient >= point.first && coefficient < point.first + 4 ? point.weight[coefficient - point.first] : 0.0;
}

/// How far two poses are apart: the rotation (rad) and the translation (m).
Vector6d difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  Vector6d result;
  result << log_so3(a.linear().transpose() * b.linear()), b.translation() - a.translation();
  return result;
}

TEST(SplineTrajectory, WeightsSumToOneAndTheirSlopesToZero) {
  const SplineTrajectory trajectory = smooth_trajectory();
  for (double t = kBegin_s; t <= kUntil_s; t += 0.0007) {
    const TrajectoryPoint point = trajectory.at(t);
    double weights = 0.0;
    double slopes = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_GE(point.weight[k], 0.0);
      weights += point.weight[k];
      slopes += point.slope[k];
    }
    EXPECT_NEAR(weights, 1.0, 1e-14);
    EXPECT_NEAR(slopes, 0.0, 1e-11);
    EXPECT_LE(trajectory.interval_begin(point.first), t);
    EXPECT_GT(trajectory.interval_begin(point.first) + kH, t);
    EXPECT_LE(point.first + 4, trajectory.coefficients().size());
  }
}

TEST(SplineTrajectory, WeightsAndSlopesGoOnAcrossKnots) {
  const SplineTrajectory trajectory = smooth_trajectory();
  for (std::size_t knot = 1; knot + 3 < trajectory.coefficients().size(); ++knot) {
    const double t = trajectory.interval_begin(knot);
    const TrajectoryPoint before = trajectory.at(t - 1e-11);
    const TrajectoryPoint after = trajectory.at(t + 1e-11);
    ASSERT_EQ(before.first + 1, after.first);
    EXPECT_NEAR(before.weight[0], 0.0, 1e-9);
    EXPECT_NEAR(after.weight[3], 0.0, 1e-9);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(before.weight[k + 1], after.weight[k], 1e-8);
      EXPECT_NEAR(before.slope[k + 1], after.slope[k], 1e-5);
    }
  }
}

TEST(SplineTrajectory, SlopesAreThoseOfTheWeights) {
  // The third derivative of a weight is at most 3 / h^3, so the central difference is off by 3 / h^3 e^2 / 6 = 3e-7.
  constexpr double kStep = 1e-6;
  const SplineTrajectory trajectory = smooth_trajectory();
  for (const double share : {0.1, 0.5, 0.83}) {
    const double t = trajectory.interval_begin(5) + share * kH;
    const TrajectoryPoint point = trajectory.at(t);
    for (std::size_t k = 0; k < 4; ++k) {
      const double slope =
          (weight_of(trajectory, point.first + k, t + kStep) - weight_of(trajectory, point.first + k, t - kStep)) /
          (2.0 * kStep);
      EXPECT_NEAR(point.slope[k], slope, 1e-6) << "share " << share;
    }
  }
}

void expect_velocities_of_the_pose(const SplineTrajectory& trajectory, double tolerance) {
  constexpr double kStep = 1e-5;
  for (double t = kBegin_s + 0.0013; t < kUntil_s - 0.001; t += 0.0031) {
    const double into = t - trajectory.interval_begin(trajectory.interval(t));
    if (into < kStep || kH - into < kStep) {
      continue;  // the third derivative jumps at a knot
    }
    const TrajectoryPoint point = trajectory.at(t);
    const Vector6d twist = log_se3(trajectory.pose(t - kStep).inverse() * trajectory.pose(t + kStep)) / (2.0 * kStep);
    EXPECT_LT((point.omega - twist.head<3>()).norm(), tolerance) << t;
    EXPECT_LT((point.velocity - twist.tail<3>()).norm(), tolerance) << t;
  }
}

TEST(SplineTrajectory, VelocitiesAreThoseOfThePose) {
  expect_velocities_of_the_pose(smooth_trajectory(), 1e-6);
  // Here velocities are tens of m/s and rad/s, and their second derivatives, times e^2 / 6, about 1e-4 of that.
  expect_velocities_of_the_pose(rough_trajectory(), 1e-3);
}

TEST(SplineTrajectory, JacobianTellsHowTheRotationDependsOnItsVector) {
  constexpr double kStep = 1e-6;
  const SplineTrajectory trajectory = rough_trajectory();
  const double t = kBegin_s + 0.07;
  const TrajectoryPoint point = trajectory.at(t);
  for (std::size_t k = 0; k < 4; ++k) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      SplineTrajectory more = trajectory;
      SplineTrajectory less = trajectory;
      more.coefficients()[point.first + k][axis] += kStep;
      less.coefficients()[point.first + k][axis] -= kStep;
      const Vector3d change = log_so3(less.at(t).R.transpose() * more.at(t).R) / (2.0 * kStep);
      EXPECT_LT((change - point.weight[k] * point.J.col(axis)).norm(), 1e-9);
    }
  }
}

TEST(SplineTrajectory, BeginsWithPoseAndVelocities) {
  const Vector3d velocity(9.0, 0.4, -0.2);
  const Vector3d omega(0.02, -0.1, 0.4);
  SplineTrajectory straight(kH);
  straight.begin(kBegin_s, kUntil_s, some_pose(), velocity, Vector3d::Zero());
  SplineTrajectory turning(kH);
  turning.begin(kBegin_s, kUntil_s, some_pose(), Vector3d::Zero(), omega);
  for (double t = kBegin_s; t <= kUntil_s; t += 0.01) {
    const Eigen::Isometry3d moved = some_pose() * Eigen::Translation3d(velocity * (t - kBegin_s));
    EXPECT_LT(difference(straight.pose(t), moved).norm(), 1e-12);
    Eigen::Isometry3d turned = some_pose();
    turned.linear() = turned.linear() * exp_so3(omega * (t - kBegin_s));
    EXPECT_LT(difference(turning.pose(t), turned).norm(), 1e-12);
  }
  SplineTrajectory both(kH);
  both.begin(kBegin_s, kUntil_s, some_pose(), velocity, omega);
  EXPECT_LT((both.at(kBegin_s).velocity - velocity).norm(), 1e-10);
  EXPECT_LT((both.at(kBegin_s).omega - omega).norm(), 1e-10);
  EXPECT_LT(difference(both.pose(kBegin_s), some_pose()).norm(), 1e-12);
}

TEST(SplineTrajectory, ReproducesAConstantTwist) {
  SplineTrajectory trajectory = smooth_trajectory();
  const double from = 3.05;
  const Eigen::Isometry3d T_map_from = trajectory.pose(from);
  Vector6d twist;
  twist << 0.05, -0.1, 0.6, 12.0, 0.5, -0.3;
  trajectory.set_constant_twist(from, twist.tail<3>(), twist.head<3>());
  // A spline through coefficients c(t) runs h^2 / 6 c'' beside c; of a circle c'' = omega x v.
  const double beside = kH * kH / 6.0 * Vector3d(twist.head<3>()).cross(Vector3d(twist.tail<3>())).norm();
  for (double t = kBegin_s; t <= kUntil_s; t += 0.004) {
    const Vector6d off = difference(T_map_from * exp_se3((t - from) * twist), trajectory.pose(t));
    EXPECT_LT(off.head<3>().norm(), 1e-6);
    EXPECT_LT(off.tail<3>().norm(), 1.1 * beside);
    EXPECT_LT((trajectory.at(t).velocity - twist.tail<3>()).norm(), 1e-3);
    EXPECT_LT((trajectory.at(t).omega - twist.head<3>()).norm(), 1e-5);
  }
}

TEST(SplineTrajectory, ExtendsEvenly) {
  SplineTrajectory trajectory(kH);
  trajectory.begin(kBegin_s, kUntil_s, some_pose(), {9.0, 0.4, -0.2}, Vector3d::Zero());
  const SplineTrajectory before = trajectory;
  const double until = 3.4;
  const std::size_t added = trajectory.extend(until, 0.1);
  EXPECT_EQ(trajectory.coefficients().size(), before.coefficients().size() + added);
  const std::size_t last = trajectory.interval(until);
  EXPECT_GT(trajectory.interval_begin(last) + kH, until) << "covered, not clamped";
  EXPECT_EQ(last + 4, trajectory.coefficients().size()) << "and no more";
  for (double t = kBegin_s; t <= until; t += 0.003) {
    if (t <= kUntil_s) {
      EXPECT_EQ(trajectory.pose(t).matrix(), before.pose(t).matrix());
    }
    EXPECT_LT((trajectory.at(t).velocity - Vector3d(9.0, 0.4, -0.2)).norm(), 1e-10);
  }
  EXPECT_EQ(trajectory.extend(3.3, 0.1), 0U) << "covered already";
}

TEST(SplineTrajectory, DropsWhatConcernsThePastOnly) {
  SplineTrajectory trajectory = rough_trajectory();
  const SplineTrajectory before = trajectory;
  const double from = 3.1;
  const std::size_t dropped = trajectory.drop_before(from);
  EXPECT_EQ(dropped, before.interval(from));
  EXPECT_EQ(trajectory.coefficients().size() + dropped, before.coefficients().size());
  EXPECT_LE(trajectory.interval_begin(0), from);
  EXPECT_GT(trajectory.interval_begin(1), from);
  for (double t = from; t <= kUntil_s; t += 0.0017) {
    EXPECT_EQ(trajectory.pose(t).matrix(), before.pose(t).matrix());
  }
  EXPECT_EQ(trajectory.drop_before(from), 0U);
}

TEST(SplineTrajectory, MovingTheReferenceLeavesThePoses) {
  SplineTrajectory trajectory = smooth_trajectory();
  const SplineTrajectory before = trajectory;
  const double to = 3.1;
  trajectory.move_reference(to);
  EXPECT_LT(difference(trajectory.reference(), before.pose(to)).norm(), 1e-12);
  EXPECT_LT(value_at(trajectory, to).norm(), 1e-7);
  for (double t = kBegin_s; t <= kUntil_s; t += 0.003) {
    // Positions change linearly; rotation vectors do to h^2 / 6 of the curvature of log(R^T exp phi).
    const Vector6d off = difference(before.pose(t), trajectory.pose(t));
    EXPECT_LT(off.head<3>().norm(), 1e-7);
    EXPECT_LT(off.tail<3>().norm(), 1e-12);
  }
}

TEST(SplineTrajectory, ChangesOfTheReferenceAreDerivatives) {
  constexpr double kStep = 1e-6;
  SplineTrajectory trajectory = rough_trajectory();
  const SplineTrajectory before = trajectory;
  const std::vector<Matrix6d> changes = trajectory.move_reference(3.1);
  ASSERT_EQ(changes.size(), before.coefficients().size());
  const Eigen::Isometry3d T_after_before = trajectory.reference().inverse() * before.reference();
  // What a coefficient of before is about the new reference.
  const auto carried = [&](const Vector6d& c) {
    Vector6d result;
    result << log_so3(T_after_before.linear() * exp_so3(c.head<3>())), T_after_before * Vector3d(c.tail<3>());
    return result;
  };
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const Vector6d& c = before.coefficients()[k];
    EXPECT_LT((carried(c) - trajectory.coefficients()[k]).norm(), 1e-10);
    Matrix6d after_by_before;
    for (Eigen::Index axis = 0; axis < 6; ++axis) {
      const Vector6d d = kStep * Vector6d::Unit(axis);
      after_by_before.col(axis) = (carried(c + d) - carried(c - d)) / (2.0 * kStep);
    }
    EXPECT_LT((after_by_before * changes[k] - Matrix6d::Identity()).norm(), 1e-8);
  }
}

TEST(TrajectoryPoint, PlacesWhatIsSeenAMomentLater) {
  const SplineTrajectory trajectory = smooth_trajectory();
  const Vector3d x(30.0, -20.0, 4.0);
  constexpr double kStep_s = 5e-4;
  for (double t = kBegin_s + 0.01; t < kUntil_s - 0.01; t += 0.013) {
    const Vector3d later = trajectory.reference().inverse() * (trajectory.pose(t + kStep_s) * x);
    // What a straight step leaves out: half of 30 m times 5 rad/s^2 times the step squared.
    EXPECT_LT((trajectory.at(t).place(x, kStep_s) - later).norm(), 3e-5);
    EXPECT_LT((trajectory.at(t).place(x, 0.0) - trajectory.reference().inverse() * (trajectory.pose(t) * x)).norm(),
              1e-12);
  }
}

TEST(SampledMotion, IsTheMotionOfTheTrajectory) {
  const SplineTrajectory trajectory = smooth_trajectory();
  const SampledMotion motion(trajectory, kBegin_s + 0.01, kUntil_s - 0.01);
  for (double t = kBegin_s + 0.01; t < kUntil_s - 0.01; t += 0.0003) {
    EXPECT_LT((motion.velocity(t) - trajectory.at(t).velocity).norm(), 1e-3);
    EXPECT_LT((motion.omega(t) - trajectory.at(t).omega).norm(), 1e-4);
  }
  EXPECT_EQ(motion.velocity(kBegin_s), motion.velocity(kBegin_s + 0.01)) << "outside as at the nearest time inside";
  const SampledMotion instant(trajectory, kBegin_s, kBegin_s);
  EXPECT_EQ(instant.velocity(kBegin_s + 1.0), trajectory.at(kBegin_s).velocity);
}

}  // namespace
}  // namespace dynamic_icp::window
