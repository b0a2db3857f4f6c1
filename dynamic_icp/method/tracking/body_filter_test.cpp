// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/motion_filter.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;
using Vector7d = MotionFilter::Vector7d;
using Matrix7d = MotionFilter::Matrix7d;

MotionFilter filter(const Vector3d& p, const Vector3d& v, double yaw_rate, double sigma = 1.0) {
  Vector7d x;
  x << p, v, yaw_rate;
  return {x, sigma * sigma * Matrix7d::Identity()};
}

TEST(MotionFilter, FollowsACircle) {
  // With speed s and yaw rate w the radius is s / w; small steps keep the second order of the motion exact enough.
  MotionFilter motion = filter({10, 0, 0}, {0, 5, 0}, 0.5);
  for (int i = 0; i < 100; ++i) {
    motion.predict(0.02, {});
  }
  const double angle = 0.5 * 2.0;
  EXPECT_NEAR(motion.position().x(), 10.0 * std::cos(angle), 1e-3);
  EXPECT_NEAR(motion.position().y(), 10.0 * std::sin(angle), 1e-3);
  EXPECT_TRUE(motion.velocity().isApprox(Vector3d(-5.0 * std::sin(angle), 5.0 * std::cos(angle), 0.0), 1e-9));
}

TEST(MotionFilter, GoesBackWhereItCameFromWithMoreUncertainty) {
  MotionFilter motion = filter({10, 3, 1}, {4, 5, 0.1}, 0.4);
  const Vector7d before = motion.state();
  motion.predict(0.1, {});
  motion.predict(-0.1, {});
  EXPECT_TRUE(motion.state().isApprox(before, 1e-3));
  EXPECT_GT(motion.covariance().trace(), 7.0);
}

TEST(MotionFilter, DopplerVelocityIsThatOfTheEquation) {
  const MotionFilter motion = filter({30, 10, 1}, {3, -8, 0.2}, 0.6);
  const Vector3d sensor(1, 2, 3);
  const Vector3d W = motion.doppler_velocity(sensor);
  EXPECT_TRUE(W.isApprox(Vector3d(3, -8, 0.2) - Vector3d(0, 0, 0.6).cross(Vector3d(29, 8, -2)), 1e-12));
  // Each point of the body has the radial velocity u . W.
  const Vector3d point(31, 9, 1.5);
  const Vector3d u = (point - sensor).normalized();
  const Vector3d velocity = Vector3d(3, -8, 0.2) + Vector3d(0, 0, 0.6).cross(point - Vector3d(30, 10, 1));
  EXPECT_NEAR(u.dot(W), u.dot(velocity), 1e-12);
}

TEST(MotionFilter, DopplerAloneDoesNotTellTurningFromMovingAcross) {
  Vector7d x = Vector7d::Zero();
  x.x() = 30.0;
  Vector7d sigma;
  sigma << 1e-3, 1e-3, 1e-3, 10.0, 10.0, 10.0, 1.0;
  MotionFilter motion(x, sigma.cwiseAbs2().asDiagonal());
  ClusterVelocity measured;
  measured.W = {5, 7, 0};
  measured.information = 1e6 * Eigen::Matrix3d::Identity();
  motion.correct_doppler(measured, Vector3d::Zero(), Eigen::Matrix3d::Zero());
  EXPECT_NEAR(motion.velocity().x(), 5.0, 0.01);
  EXPECT_NEAR(motion.velocity().y() - 30.0 * motion.yaw_rate(), 7.0, 0.01) << "W = V - Omega x c";
  EXPECT_GT(motion.covariance()(4, 4), 25.0) << "the part across stays unknown";
  EXPECT_LT(motion.covariance()(3, 3), 1e-3);
}

TEST(MotionFilter, AReferencePointMovesAsTheBodyTurns) {
  MotionFilter motion = filter({30, 0, 0}, {0, 8, 0}, 0.5);
  const Vector3d sensor(2, 1, 0);
  const Vector3d W = motion.doppler_velocity(sensor);
  motion.move_reference({2, 0, 0});
  EXPECT_EQ(motion.position(), Vector3d(32, 0, 0));
  EXPECT_TRUE(motion.velocity().isApprox(Vector3d(0, 9, 0), 1e-12)) << "omega x shift";
  EXPECT_TRUE(motion.doppler_velocity(sensor).isApprox(W, 1e-12)) << "the sensor sees the same";
}

TEST(MotionFilter, ARestartOfThePositionSaysNothingOfTheVelocity) {
  MotionFilter motion = filter({30, 0, 0}, {0, 8, 0}, 0.0);
  motion.predict(0.5, {});
  const Vector3d velocity = motion.velocity();
  motion.restart_position({100, 0, 0}, 0.01);
  motion.correct_position(Vector3d::UnitX(), 100.3, 0.01);
  EXPECT_EQ(motion.velocity(), velocity);
  EXPECT_NEAR(motion.position().x(), 100.15, 1e-9);
}

TEST(MotionFilter, OneWildMeasurementMovesTheStateLittle) {
  MotionFilter motion = filter({0, 0, 0}, {0, 0, 0}, 0.0, 0.1);
  const double likely = motion.correct_position(Vector3d::UnitX(), 0.05, 0.01);
  MotionFilter other = filter({0, 0, 0}, {0, 0, 0}, 0.0, 0.1);
  const double unlikely = other.correct_position(Vector3d::UnitX(), 50.0, 0.01);
  EXPECT_LT(other.position().x(), 0.3);
  EXPECT_GT(likely, unlikely);
}

TEST(MotionFilter, IsConsistentInALinearCase) {
  // Straight motion with the noise the filter expects, positions measured every 0.1 s: the normalised squared error of
  // position and velocity has the mean 6 over many runs.
  constexpr int kRuns = 150;
  constexpr double kSigma = 0.1;
  MotionNoise noise{1.0, 1.0, 1.0, 1e-6};
  double sum = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const RandomSource random = RandomSource(17).fork(run);
    std::uint64_t stream = 0;
    const auto normals = [&] {
      const Vector3d n(random.normal(stream), random.normal(stream + 1), random.normal(stream + 2));
      stream += 3;
      return n;
    };
    Vector7d x = Vector7d::Zero();
    Matrix7d P = Matrix7d::Identity();
    P(6, 6) = 1e-12;
    Vector3d p = normals();
    Vector3d v = normals();
    MotionFilter motion(x, P);
    for (int k = 0; k < 15; ++k) {
      // White acceleration over dt: covariance [dt^3/3, dt^2/2; dt^2/2, dt] q.
      const double dt = 0.1;
      const Vector3d a = normals();
      const Vector3d b = normals();
      p += dt * v + std::sqrt(dt * dt * dt / 3.0) * a;
      v += std::sqrt(dt) * (std::sqrt(0.75) * a + 0.5 * b);
      motion.predict(dt, noise);
      const Vector3d z = p + kSigma * normals();
      for (int axis = 0; axis < 3; ++axis) {
        motion.correct_position(Vector3d::Unit(axis), z[axis], kSigma * kSigma);
      }
    }
    Eigen::Matrix<double, 6, 1> e;
    e << motion.position() - p, motion.velocity() - v;
    sum += dense::normalised_squared(e, motion.covariance().topLeftCorner<6, 6>());
  }
  // Of a chi-squared variable with 900 degrees of freedom over 150: 6 +- 4 * 0.28.
  EXPECT_NEAR(sum / kRuns, 6.0, 1.13);
}

TEST(MotionFilter, CovarianceStaysSymmetricAndPositive) {
  MotionFilter motion = filter({30, 5, 0}, {3, 8, 0}, 0.5, 3.0);
  ClusterVelocity measured;
  measured.W = {5, 7, 0};
  measured.information = Vector3d(1e5, 10.0, 0.1).asDiagonal();
  for (int i = 0; i < 100; ++i) {
    motion.predict(0.1, {});
    motion.correct_doppler(measured, Vector3d::Zero(), 1e-3 * Eigen::Matrix3d::Identity());
    motion.correct_position(Vector3d::UnitY(), 5.0 + 0.8 * i, 0.01);
  }
  const Matrix7d& P = motion.covariance();
  EXPECT_TRUE(P.isApprox(P.transpose(), 1e-9));
  EXPECT_GT(dense::symmetric_parts(P).values.minCoeff(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::tracking
