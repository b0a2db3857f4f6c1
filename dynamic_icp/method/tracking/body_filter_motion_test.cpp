// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// How a body moves between two scans, and what that says of the velocities of its points.
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/body_filter.hpp"

#include "testing/filtered_body.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using State = BodyFilter::Vector;
using Covariance = BodyFilter::Matrix;

const MotionNoise kNoNoise{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

TEST(BodyFilterMotion, FollowsACircle) {
  // With speed s and yaw rate w the radius is s / w; small steps keep the second order of the motion exact enough.
  BodyFilter body = body_with({10, 0, 0}, {0, 5, 0}, 0.5);
  for (int i = 0; i < 100; ++i) {
    body.predict(0.02, {});
  }
  const double angle = 0.5 * 2.0;
  EXPECT_NEAR(body.position().x(), 10.0 * std::cos(angle), 1e-3);
  EXPECT_NEAR(body.position().y(), 10.0 * std::sin(angle), 1e-3);
  EXPECT_TRUE(body.velocity().isApprox(Vector3d(-5.0 * std::sin(angle), 5.0 * std::cos(angle), 0.0), 1e-9));
  EXPECT_NEAR(body.yaw(), angle, 1e-12);
}

TEST(BodyFilterMotion, GoesBackWhereItCameFromWithMoreUncertainty) {
  BodyFilter body = body_with({10, 3, 1}, {4, 5, 0}, 0.4);
  const State before = body.state();
  body.predict(0.1, {});
  body.predict(-0.1, {});
  EXPECT_TRUE(body.state().isApprox(before, 1e-3));
  EXPECT_GT(body.covariance().trace(), static_cast<double>(BodyFilter::kStates));
}

TEST(BodyFilterMotion, PropagatesTheCovarianceByTheDerivativesOfTheMotion) {
  for (const double dt : {0.1, 0.7, -0.3}) {
    const BodyFilter before = any_body(3);
    BodyFilter after = before;
    after.predict(dt, kNoNoise);
    const auto F = derivatives<BodyFilter::kStates>(
        [&](const State& x) {
          BodyFilter body = with_state(before, x);
          body.predict(dt, kNoNoise);
          return body.state();
        },
        before.state());
    Covariance expected = F * before.covariance() * F.transpose();
    const Covariance difference = after.covariance() - expected;
    // Faces walk a little even so.
    for (int i = 0; i < BodyFilter::kStates; ++i) {
      for (int k = 0; k < BodyFilter::kStates; ++k) {
        const double allowed = i == k && i >= BodyFilter::kFirstFace ? 1e-3 : 1e-7;
        EXPECT_LT(std::abs(difference(i, k)), allowed) << i << " " << k << " after " << dt;
      }
    }
    EXPECT_GE(difference.diagonal().minCoeff(), -1e-7);
  }
}

TEST(BodyFilterMotion, NoiseOfTwoHalfStepsIsThatOfAWholeOne) {
  // Straight motion of a body without heading, where the equations are linear.
  const State x = state_of({3, 4, 0}, {6, 8, 0}, 0.9, 0.0);
  BodyFilter once(x, Covariance::Zero(), Matrix3d::Identity());
  BodyFilter twice = once;
  const MotionNoise noise{2.0, 0.7, 0.3, 0.0, 5.0, 0.0};
  once.predict(0.4, noise);
  twice.predict(0.2, noise);
  twice.predict(0.2, noise);
  EXPECT_LT((once.covariance() - twice.covariance()).cwiseAbs().maxCoeff(), 1e-9);
  // Over t the variance of the velocity is q t, that of the position q t^3 / 3.
  const Vector3d along(0.6, 0.8, 0.0);
  const Vector3d across(-0.8, 0.6, 0.0);
  const Matrix3d position = once.covariance().topLeftCorner<3, 3>();
  const Matrix3d velocity = once.covariance().block<3, 3>(3, 3);
  EXPECT_NEAR(along.dot(velocity * along), 4.0 * 0.4, 1e-9);
  EXPECT_NEAR(across.dot(velocity * across), 0.49 * 0.4, 1e-9);
  EXPECT_NEAR(along.dot(position * along), 4.0 * 0.064 / 3.0, 1e-9);
  // Of the vertical velocity it is s^2 (1 - exp(-2 t / tau)), as of every Ornstein-Uhlenbeck process.
  EXPECT_NEAR(velocity(2, 2), 0.09 * (1.0 - std::exp(-0.8)), 1e-9);
}

TEST(BodyFilterMotion, AccelerationsAreAnOrnsteinUhlenbeckProcessAhead) {
  const double yaw = std::atan2(0.8, 0.6);
  const State x = state_of({3, 4, 0}, {6, 8, 0}, yaw, 0.0);
  BodyFilter once(x, 1e-14 * Covariance::Identity(), Matrix3d::Identity());
  BodyFilter twice = once;
  const MotionNoise noise{9.0, 0.0, 0.0, 0.0, 1.5, 0.0};
  once.predict(0.8, noise);
  twice.predict(0.4, noise);
  twice.predict(0.4, noise);
  EXPECT_LT((once.covariance() - twice.covariance()).cwiseAbs().maxCoeff(), 1e-9);
  // The way, the speed and the acceleration ahead, by the sum over short steps of noise that is white in each.
  constexpr int kSteps = 8000;
  const double dt = 0.8 / kSteps;
  Matrix3d P = Matrix3d::Zero();
  const Matrix3d F{{1.0, dt, 0.0}, {0.0, 1.0, dt}, {0.0, 0.0, 1.0 - dt / 2.0}};
  for (int i = 0; i < kSteps; ++i) {
    P = (F * P * F.transpose()).eval();
    P(2, 2) += 2.0 * 1.5 * 1.5 / 2.0 * dt;
  }
  Eigen::Matrix<double, 3, BodyFilter::kStates> ahead = Eigen::Matrix<double, 3, BodyFilter::kStates>::Zero();
  ahead.block<1, 2>(0, 0) << 0.6, 0.8;
  ahead.block<1, 2>(1, 3) << 0.6, 0.8;
  ahead(2, BodyFilter::kAcceleration) = 1.0;
  const Matrix3d along = ahead * once.covariance() * ahead.transpose();
  EXPECT_LT((along - P).cwiseQuotient(P).cwiseAbs().maxCoeff(), 2e-3) << along << "\n" << P;
  EXPECT_NEAR(once.covariance()(2, 2), 0.0, 1e-9) << "nothing up";
}

TEST(BodyFilterMotion, AnAccelerationIsSpeedAndWayUntilItFades) {
  // a(t) = a exp(-t / 2 s), summed up in short steps.
  State x = state_of({0, 0, 0}, {3, 0, 0}, 0.0, 0.0);
  x[BodyFilter::kAcceleration] = 2.0;
  BodyFilter body = with_state(body_with({}, {}, 0.0), x);
  body.predict(1.5, kNoNoise);
  double way = 0.0;
  double speed = 3.0;
  constexpr double kStep_s = 1e-5;
  for (int i = 0; i < 150000; ++i) {
    way += kStep_s * speed;
    speed += kStep_s * 2.0 * std::exp(-i * kStep_s / 2.0);
  }
  EXPECT_NEAR(body.position().x(), way, 1e-4);
  EXPECT_NEAR(body.velocity().x(), speed, 1e-4);
  EXPECT_NEAR(body.acceleration(), 2.0 * std::exp(-0.75), 1e-12);
}

TEST(BodyFilterMotion, WhatBrakesStandsAtLast) {
  for (const double yaw : {0.0, 3.14159265358979}) {  // ahead and backwards
    State x = state_of({0, 0, 0}, {4, 0, 0}, yaw, 0.0);
    x[BodyFilter::kAcceleration] = yaw > 0.0 ? 5.0 : -5.0;
    BodyFilter body = with_state(body_with({}, {}, 0.0), x);
    body.predict(3.0, kNoNoise);
    EXPECT_NEAR(body.velocity().norm(), 0.0, 1e-9);
    EXPECT_EQ(body.acceleration(), 0.0);
    // It stands when 4 = 5 * 2 (1 - exp(-t / 2)); the way is the integral of the speed until then.
    const double stop_s = -2.0 * std::log(1.0 - 4.0 / 10.0);
    EXPECT_NEAR(body.position().x(), 4.0 * stop_s - 5.0 * 2.0 * (stop_s - 0.4 * 2.0), 1e-9);
  }
}

TEST(BodyFilter, WhatLeavesTheGroundComesBackToIt) {
  // With tau = 1 s it climbs v tau in all, and in the long run only its typical velocity is known.
  BodyFilter body = body_with({0, 0, 0}, {5, 0, 2}, 0.0);
  MotionNoise noise;
  noise.vertical_mps = 0.3;
  noise.slope = 0.0;
  for (int i = 0; i < 200; ++i) {
    body.predict(0.1, noise);
  }
  EXPECT_NEAR(body.position().z(), 2.0, 1e-6);
  EXPECT_NEAR(body.velocity().z(), 0.0, 1e-6);
  EXPECT_NEAR(body.covariance()(5, 5), 0.09, 1e-6);
  EXPECT_NEAR(body.position().x(), 100.0, 1e-9);
}

TEST(BodyFilterMotion, WhatIsFastClimbsFaster) {
  MotionNoise noise;
  noise.vertical_mps = 0.3;
  noise.slope = 0.02;
  BodyFilter body = body_with({0, 0, 0}, {20, 0, 0}, 0.0, 1e-4);
  body.predict(20.0, noise);
  EXPECT_NEAR(body.covariance()(5, 5), 0.09 + 0.16, 1e-6);
}

TEST(BodyFilterMotion, NoiseOfTheYawRateAddsUpInTheYaw) {
  const MotionNoise noise{0.0, 0.0, 0.0, 0.5, 0.0, 0.0};
  BodyFilter once = body_with({3, 4, 0}, {0, 0, 0}, 0.0);
  BodyFilter twice = once;
  once.predict(0.4, noise);
  twice.predict(0.2, noise);
  twice.predict(0.2, noise);
  const Eigen::Matrix2d P = once.covariance().block<2, 2>(BodyFilter::kYaw, BodyFilter::kYaw);
  EXPECT_TRUE((P.isApprox(twice.covariance().block<2, 2>(BodyFilter::kYaw, BodyFilter::kYaw), 1e-12)));
  EXPECT_NEAR(P(0, 0), 1.0 + 0.16 + 0.25 * 0.064 / 3.0, 1e-12);
  EXPECT_NEAR(P(1, 1), 1.0 + 0.25 * 0.4, 1e-12);
}

TEST(BodyFilterMotion, DopplerVelocityIsThatOfTheEquation) {
  const BodyFilter body = body_with({30, 10, 1}, {3, -8, 0.2}, 0.6);
  const Vector3d sensor(1, 2, 3);
  const Vector3d W = body.doppler_velocity(sensor);
  EXPECT_TRUE(W.isApprox(Vector3d(3, -8, 0.2) - Vector3d(0, 0, 0.6).cross(Vector3d(29, 8, -2)), 1e-12));
  // Each point of the body has the radial velocity u . W.
  const Vector3d point(31, 9, 1.5);
  const Vector3d u = (point - sensor).normalized();
  const Vector3d velocity = Vector3d(3, -8, 0.2) + Vector3d(0, 0, 0.6).cross(point - Vector3d(30, 10, 1));
  EXPECT_NEAR(u.dot(W), u.dot(velocity), 1e-12);
}

TEST(BodyFilterMotion, CovariancesOfVelocitiesGoByTheirDerivatives) {
  const BodyFilter body = any_body(4);
  const Vector3d sensor(2, -3, 0.5);
  const Vector3d from_reference(2.1, -0.6, 0.3);
  const auto of_W =
      derivatives<3>([&](const State& x) { return with_state(body, x).doppler_velocity(sensor); }, body.state());
  EXPECT_LT((body.doppler_covariance(sensor) - of_W * body.covariance() * of_W.transpose()).norm(), 1e-6);
  const auto of_v =
      derivatives<3>([&](const State& x) { return with_state(body, x).velocity_at(from_reference); }, body.state());
  EXPECT_LT((body.velocity_covariance_at(from_reference) - of_v * body.covariance() * of_v.transpose()).norm(), 1e-6);
}

TEST(BodyFilterMotion, VelocityOfAPointIsTheChangeOfItsPosition) {
  const BodyFilter now = any_body(5);
  const Vector3d from_reference(2.1, -0.6, 0.3);
  const auto place_after = [&](double dt) -> Vector3d {
    BodyFilter body = now;
    body.predict(dt, kNoNoise);
    return body.position() + body.axes() * from_reference;
  };
  const Vector3d velocity = (place_after(5e-7) - place_after(-5e-7)) / 1e-6;
  EXPECT_LT((now.velocity_at(from_reference) - velocity).norm(), 1e-6);
  // And the sensor sees the same body whichever point of it is the reference.
  State elsewhere = now.state();
  elsewhere.head<3>() += now.axes() * from_reference;
  elsewhere.segment<3>(3) = now.velocity_at(from_reference);
  const Vector3d sensor(2, -3, 0.5);
  EXPECT_TRUE(with_state(now, elsewhere).doppler_velocity(sensor).isApprox(now.doppler_velocity(sensor), 1e-12));
}

}  // namespace
}  // namespace dynamic_icp::tracking
