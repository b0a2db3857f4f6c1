// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/body_filter.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/se3.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/filtered_body.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using State = BodyFilter::Vector;
using Covariance = BodyFilter::Matrix;

constexpr int kYaw = BodyFilter::kYaw;
constexpr int kYawRate = BodyFilter::kYawRate;
constexpr int kFace = BodyFilter::kFirstFace;

using Measurement = std::function<double(const State&)>;

/// Whether `after` is what Kalman's equations make of `before` and a measurement, `function` of the state, of `value`.
void expect_corrected(const BodyFilter& before, const BodyFilter& after, const Measurement& function, double value,
                      double variance) {
  const auto row =
      derivatives<1>([&](const State& x) { return Eigen::Matrix<double, 1, 1>(function(x)); }, before.state());
  const Covariance& P = before.covariance();
  const State PHt = P * row.transpose();
  const double S = row.dot(PHt) + variance;
  const double residual = value - function(before.state());
  ASSERT_LT(residual * residual, 9.0 * S) << "a test of the linear range";
  const State x = before.state() + PHt / S * residual;
  const Covariance expected = P - PHt * PHt.transpose() / S;
  EXPECT_LT((after.state() - x).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_LT((after.covariance() - expected).cwiseAbs().maxCoeff(), 1e-7);
}

Matrix3d box_axes(const Matrix3d& level, double yaw) {
  return level * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
}

TEST(BodyFilter, AFaceIsAPlaneOfTheBox) {
  const BodyFilter before = any_body(6);
  for (const Face face : kFaces) {
    const Vector3d outward = side_of(face) * before.axes().col(axis_of(face));
    // Somewhere on the face, 0.2 m farther out than thought.
    const Vector3d beside = before.axes() * Vector3d(0.9, -0.5, 0.3);
    const Vector3d seen =
        before.position() + (before.distance(face) + 0.2) * outward + beside - outward.dot(beside) * outward;
    BodyFilter after = before;
    after.correct_face(face, seen, 0.01);
    const Measurement outside = [&](const State& x) {
      const Vector3d normal = side_of(face) * box_axes(before.level(), x[kYaw]).col(axis_of(face));
      return normal.dot(seen - x.head<3>()) - x[kFace + static_cast<int>(face)];
    };
    SCOPED_TRACE(static_cast<int>(face));
    expect_corrected(before, after, outside, 0.0, 0.01);
  }
}

TEST(BodyFilter, AFaceMeasuredMakesItsPlaneBetterKnown) {
  // From the outside, without the equations: the measured plane goes through the point when it is exact.
  BodyFilter body = any_body(7);
  const Vector3d seen = body.position() + body.axes() * Vector3d(2.6, 0.4, 0.2);
  for (int i = 0; i < 10; ++i) {
    body.correct_face(Face::kFront, seen, 1e-8);
  }
  EXPECT_NEAR(body.axes().col(0).dot(seen - body.position()), body.distance(Face::kFront), 1e-4);
}

TEST(BodyFilter, ItsMiddleHasNoSideslip) {
  const BodyFilter before = any_body(8);
  BodyFilter after = before;
  after.correct_sideslip(0.04);
  const Measurement to_the_left = [&](const State& x) {
    const Matrix3d axes = box_axes(before.level(), x[kYaw]);
    const Vector3d middle = 0.5 * (x[kFace] - x[kFace + 1]) * axes.col(0);
    const Vector3d velocity = x.segment<3>(3) + x[kYawRate] * axes.col(2).cross(middle);
    return axes.col(1).dot(velocity);
  };
  expect_corrected(before, after, to_the_left, 0.0, 0.04);
}

TEST(BodyFilter, DopplerIsAMeasurementOfW) {
  const BodyFilter before = any_body(9);
  const Vector3d sensor(2, -3, 0.5);
  const Vector3d e = Vector3d(1.0, 0.4, -0.2).normalized();  // the only direction with information
  ClusterVelocity measured;
  measured.W = before.doppler_velocity(sensor) + Vector3d(0.3, -0.1, 0.2);
  measured.information = 25.0 * e * e.transpose();
  const Matrix3d floor = Vector3d(0.01, 0.02, 0.03).asDiagonal();
  BodyFilter after = before;
  after.correct_doppler(measured, sensor, floor);
  const Measurement along = [&](const State& x) {
    const Vector3d turning = x[kYawRate] * before.level().col(2);
    return e.dot(x.segment<3>(3) - turning.cross(x.head<3>() - sensor));
  };
  expect_corrected(before, after, along, e.dot(measured.W), 0.04 + e.dot(floor * e));
}

TEST(BodyFilter, OtherMeasurementsFollowKalmansEquationsToo) {
  const BodyFilter before = any_body(10);
  BodyFilter after = before;
  after.correct_yaw(before.yaw() + 0.1 - 2.0 * std::numbers::pi, 0.01);  // a whole turn is none
  expect_corrected(
      before, after, [](const State& x) { return x[kYaw]; }, before.yaw() + 0.1, 0.01);
  after = before;
  after.correct_yaw_rate(0.6, 0.01);
  expect_corrected(
      before, after, [](const State& x) { return x[kYawRate]; }, 0.6, 0.01);
  for (const int axis : {0, 1, 2}) {
    const Vector3d direction = before.axes().col(axis);
    after = before;
    after.correct_position(axis, before.position() + 0.2 * direction, 0.01);
    expect_corrected(
        before, after, [&](const State& x) { return direction.dot(x.head<3>()); },
        direction.dot(before.position()) + 0.2, 0.01);
  }
}

TEST(BodyFilter, DopplerAloneDoesNotTellTurningFromMovingAcross) {
  State x = State::Zero();
  x.x() = 30.0;
  State sigma = State::Ones();
  sigma.head<9>() << 1e-3, 1e-3, 1e-3, 10.0, 10.0, 10.0, 1.0, 1.0, 1.0;
  BodyFilter body(x, sigma.cwiseAbs2().asDiagonal(), Matrix3d::Identity());
  ClusterVelocity measured;
  measured.W = {5, 7, 0};
  measured.information = 1e6 * Matrix3d::Identity();
  body.correct_doppler(measured, Vector3d::Zero(), Matrix3d::Zero());
  EXPECT_NEAR(body.velocity().x(), 5.0, 0.01);
  EXPECT_NEAR(body.velocity().y() - 30.0 * body.yaw_rate(), 7.0, 0.01) << "W = V - Omega x c";
  EXPECT_GT(body.covariance()(4, 4), 25.0) << "the part across stays unknown";
  EXPECT_LT(body.covariance()(3, 3), 1e-3);
}

TEST(BodyFilter, AFaceThatComesIntoViewIsNoMotion) {
  State x = state_of({20, 0, 0}, {8, 0, 0}, 0.0, 0.0);
  x[kFace] = 0.0;
  State variances = State::Constant(1e-4);
  variances[kFace] = 100.0;
  BodyFilter body(x, variances.asDiagonal(), Matrix3d::Identity());
  body.predict(0.1, {});
  const Vector3d position = body.position();
  const Vector3d velocity = body.velocity();
  body.correct_face(Face::kFront, position + Vector3d(4.0, 0.7, 0.0), 0.01);
  EXPECT_NEAR(body.distance(Face::kFront), 4.0, 1e-2);
  EXPECT_LT((body.position() - position).norm(), 1e-3);
  EXPECT_LT((body.velocity() - velocity).norm(), 1e-2);
  EXPECT_LT(body.variance(Face::kFront), 0.02);
  // Once its place is known the same face shows motion.
  for (int i = 0; i < 10; ++i) {
    body.predict(0.1, {});
    body.correct_face(Face::kFront, position + Vector3d(4.0 + 0.1 * (i + 1) * 10.0, 0.7, 0.0), 0.01);
  }
  EXPECT_GT(body.velocity().x(), 8.5);
}

TEST(BodyFilter, OfAForgottenFaceNothingIsKnownButThatItIsThere) {
  const BodyFilter before = any_body(11);
  BodyFilter after = before;
  after.forget_face(Face::kLeft, 100.0);
  EXPECT_EQ(after.state(), before.state());
  EXPECT_EQ(after.variance(Face::kLeft), 100.0);
  const int i = kFace + static_cast<int>(Face::kLeft);
  for (int row = 0; row < BodyFilter::kStates; ++row) {
    for (int column = 0; column < BodyFilter::kStates; ++column) {
      if (row != i && column != i) {
        EXPECT_EQ(after.covariance()(row, column), before.covariance()(row, column));
      } else if (row != column) {
        EXPECT_EQ(after.covariance()(row, column), 0.0);
      }
    }
  }
}

TEST(BodyFilter, TurnedAroundTheBoxIsWhereItWas) {
  const BodyFilter before = any_body(12);
  BodyFilter after = before;
  after.turn_around();
  EXPECT_NEAR(std::abs(std::remainder(after.yaw() - before.yaw(), 2.0 * std::numbers::pi)), std::numbers::pi, 1e-9);
  EXPECT_EQ(after.position(), before.position());
  EXPECT_EQ(after.velocity(), before.velocity());
  EXPECT_EQ(after.yaw_rate(), before.yaw_rate());
  EXPECT_EQ(after.acceleration(), -before.acceleration());
  for (const Face face : kFaces) {
    // The face of the turned box that looks in the same direction.
    const Vector3d outward = side_of(face) * before.axes().col(axis_of(face));
    int found = 0;
    for (const Face other : kFaces) {
      if ((side_of(other) * after.axes().col(axis_of(other))).dot(outward) < 0.99) {
        continue;
      }
      ++found;
      EXPECT_NEAR(after.distance(other), before.distance(face), 1e-12);
      EXPECT_NEAR(after.variance(other), before.variance(face), 1e-12);
      const int i = kFace + static_cast<int>(face);
      const int k = kFace + static_cast<int>(other);
      State column = before.covariance().col(i);
      column[BodyFilter::kAcceleration] *= -1.0;  // ahead is the other way
      EXPECT_TRUE((after.covariance().block<kFace, 1>(0, k).isApprox(column.head<kFace>())));
      EXPECT_TRUE((after.covariance().block<1, kFace>(k, 0).transpose().isApprox(column.head<kFace>())));
    }
    EXPECT_EQ(found, 1);
  }
  EXPECT_EQ(after.covariance(Face::kFront, Face::kLeft), before.covariance(Face::kRear, Face::kRight));
  EXPECT_EQ(after.covariance(Face::kFront, Face::kTop), before.covariance(Face::kRear, Face::kTop));
  EXPECT_TRUE(after.covariance().isApprox(after.covariance().transpose(), 1e-12));
  after.turn_around();
  EXPECT_TRUE(after.covariance().isApprox(before.covariance(), 1e-12)) << "and back";
}

/// Some scans of a body that is seen from the origin, everything turned by `R`.
BodyFilter after_some_scans(const Matrix3d& R) {
  State x = state_of(R * Vector3d(30, 8, 1), R * Vector3d(4, 9, 0.3), 1.1, 0.4);
  Covariance P = Covariance::Identity();
  P.diagonal() << 0.1, 0.2, 0.3, 4.0, 9.0, 1.0, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  P.topLeftCorner<3, 3>() = R * P.topLeftCorner<3, 3>() * R.transpose();
  P.block<3, 3>(3, 3) = R * P.block<3, 3>(3, 3) * R.transpose();
  BodyFilter body(x, P, R);
  ClusterVelocity measured;
  measured.W = R * Vector3d(4.5, 8, 0.2);
  measured.information = R * Vector3d(400, 50, 3).asDiagonal() * R.transpose();
  const Matrix3d floor = R * Vector3d(0.001, 0.002, 0.01).asDiagonal() * R.transpose();
  for (int i = 0; i < 5; ++i) {
    body.predict(0.1, {});
    body.correct_doppler(measured, R * Vector3d(0.1 * i, 0, 0), floor);
    body.correct_yaw(1.15, 0.01);
    body.correct_sideslip(0.04);
    for (const Face face : kFaces) {
      body.correct_face(face, R * Vector3d(31 + 0.4 * i, 9 + 0.9 * i, 1.5), 0.02);
    }
    body.correct_position(1, R * Vector3d(30 + 0.4 * i, 8 + 0.9 * i, 1), 0.1);
  }
  return body;
}

TEST(BodyFilter, OnASlopeAllIsAsOnLevelGround) {
  const Matrix3d R = exp_so3({0.2, -0.3, 0.9});
  const BodyFilter level = after_some_scans(Matrix3d::Identity());
  const BodyFilter slope = after_some_scans(R);
  Covariance turn = Covariance::Identity();
  turn.topLeftCorner<3, 3>() = R;
  turn.block<3, 3>(3, 3) = R;
  EXPECT_LT((slope.state() - turn * level.state()).norm(), 1e-9);
  EXPECT_LT((slope.covariance() - turn * level.covariance() * turn.transpose()).norm(), 1e-9);
  EXPECT_LT((slope.axes() - R * level.axes()).norm(), 1e-9);
}

TEST(BodyFilter, OneWildMeasurementMovesTheStateLittle) {
  BodyFilter body = body_with({0, 0, 0}, {0, 0, 0}, 0.0, 0.1);
  const double likely = body.correct_position(0, {0.05, 0, 0}, 0.01);
  BodyFilter other = body_with({0, 0, 0}, {0, 0, 0}, 0.0, 0.1);
  const double unlikely = other.correct_position(0, {50.0, 0, 0}, 0.01);
  EXPECT_LT(other.position().x(), 0.3);
  EXPECT_GT(likely, unlikely);
}

TEST(BodyFilter, IsConsistentInALinearCase) {
  // Straight motion with the noise the filter expects, positions measured every 0.1 s: the normalised squared error of
  // position and velocity has the mean 6 over many runs.
  constexpr int kRuns = 150;
  constexpr double kSigma = 0.1;
  const MotionNoise noise{1.0, 1.0, 1.0, 1e-6, 0.0, 0.0};
  double sum = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const RandomSource random = RandomSource(17).fork(run);
    std::uint64_t stream = 0;
    const auto normals = [&] {
      const Vector3d n(random.normal(stream), random.normal(stream + 1), random.normal(stream + 2));
      stream += 3;
      return n;
    };
    Covariance P = Covariance::Identity();
    P(kYaw, kYaw) = 1e-12;
    P(kYawRate, kYawRate) = 1e-12;
    Vector3d p = normals();
    Vector3d v = normals();
    BodyFilter body(State::Zero(), P, Matrix3d::Identity());
    for (int k = 0; k < 15; ++k) {
      // White acceleration over dt: covariance [dt^3/3, dt^2/2; dt^2/2, dt] q.
      const double dt = 0.1;
      const Vector3d a = normals();
      const Vector3d b = normals();
      p += dt * v + std::sqrt(dt * dt * dt / 3.0) * a;
      v += std::sqrt(dt) * (std::sqrt(0.75) * a + 0.5 * b);
      body.predict(dt, noise);
      const Vector3d z = p + kSigma * normals();
      for (int axis = 0; axis < 3; ++axis) {
        body.correct_position(axis, z, kSigma * kSigma);
      }
    }
    Eigen::Matrix<double, 6, 1> e;
    e << body.position() - p, body.velocity() - v;
    sum += dense::normalised_squared(e, body.covariance().topLeftCorner<6, 6>());
  }
  // Of a chi-squared variable with 900 degrees of freedom over 150: 6 +- 4 * 0.28.
  EXPECT_NEAR(sum / kRuns, 6.0, 1.13);
}

TEST(BodyFilter, SpeedsThatGrowShowAnAcceleration) {
  BodyFilter body = body_with({30, 0, 0}, {5, 0, 0}, 0.0, 1.0);
  ClusterVelocity measured;
  measured.information = 400.0 * Matrix3d::Identity();
  for (int i = 1; i <= 15; ++i) {
    body.predict(0.1, {});
    measured.W = {5.0 + 0.1 * i * 2.0, 0, 0};
    body.correct_yaw(0.0, 1e-4);
    body.correct_yaw_rate(0.0, 1e-4);
    body.correct_doppler(measured, {0, 0, 0}, Matrix3d::Zero());
  }
  EXPECT_NEAR(body.acceleration(), 2.0, 0.4);
  const double sigma = std::sqrt(body.covariance()(BodyFilter::kAcceleration, BodyFilter::kAcceleration));
  EXPECT_LT(sigma, 1.0) << "1.5 before";
  body.stop(0.01);
  EXPECT_EQ(body.acceleration(), 0.0);
  EXPECT_LT(body.velocity().norm(), 8.0);
}

TEST(BodyFilter, FollowsWhatBrakesAsHardAsItCan) {
  BodyFilter body = body_with({30, 0, 0}, {15, 0, 0}, 0.0, 1.0);
  ClusterVelocity measured;
  measured.information = 400.0 * Matrix3d::Identity();
  double speed = 15.0;
  for (int i = 0; i < 50; ++i) {
    body.predict(0.1, {});
    speed = i < 20 ? 15.0 : std::max(0.0, speed - 0.1 * 8.0);
    measured.W = {speed, 0, 0};
    body.correct_yaw(0.0, 1e-4);
    body.correct_yaw_rate(0.0, 1e-4);
    body.correct_doppler(measured, {0, 0, 0}, 0.0016 * Matrix3d::Identity());
    EXPECT_LT(std::abs(body.velocity().x() - speed), 0.35) << "in scan " << i;
  }
}

TEST(BodyFilter, CovarianceStaysSymmetricAndPositive) {
  BodyFilter body = body_with({30, 5, 0}, {3, 8, 0}, 0.5, 3.0);
  ClusterVelocity measured;
  measured.W = {5, 7, 0};
  measured.information = Vector3d(1e5, 10.0, 0.1).asDiagonal();
  for (int i = 0; i < 100; ++i) {
    body.predict(0.1, {});
    body.correct_doppler(measured, Vector3d::Zero(), 1e-3 * Matrix3d::Identity());
    body.correct_position(1, {30.0, 5.0 + 0.8 * i, 0.0}, 0.01);
    body.correct_face(Face::kRear, {28.0, 5.0 + 0.8 * i, 0.0}, 0.01);
  }
  const Covariance& P = body.covariance();
  EXPECT_TRUE(P.isApprox(P.transpose(), 1e-9));
  EXPECT_GT(dense::symmetric_parts(P).values.minCoeff(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::tracking
