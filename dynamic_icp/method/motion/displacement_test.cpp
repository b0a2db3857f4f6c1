// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/displacement.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::motion {
namespace {

using Eigen::Vector3d;

TEST(QuadratureWeights, AreThoseOfTheTextbooks) {
  const double dt = 0.1;
  const auto trapezoid = quadrature_weights(std::array{1.0, 1.1}, 1.0, 1.1);
  EXPECT_NEAR(trapezoid[0], dt / 2.0, 1e-12);
  EXPECT_NEAR(trapezoid[1], dt / 2.0, 1e-12);
  const auto adams_moulton = quadrature_weights(std::array{0.9, 1.0, 1.1}, 1.0, 1.1);
  EXPECT_NEAR(adams_moulton[0], -dt / 12.0, 1e-12);
  EXPECT_NEAR(adams_moulton[1], 8.0 * dt / 12.0, 1e-12);
  EXPECT_NEAR(adams_moulton[2], 5.0 * dt / 12.0, 1e-12);
  EXPECT_NEAR(quadrature_weights(std::array{3.0}, 1.0, 1.1)[0], dt, 1e-12);
}

TEST(QuadratureWeights, IntegrateQuadraticsExactlyAtUnequalSteps) {
  const std::array times = {0.83, 1.04, 1.17};
  const auto weights = quadrature_weights(times, 1.0, 1.12);
  const auto f = [](double t) { return 3.0 - 2.0 * t + 5.0 * t * t; };
  const auto F = [](double t) { return 3.0 * t - t * t + 5.0 / 3.0 * t * t * t; };
  double sum = 0.0;
  for (std::size_t j = 0; j < times.size(); ++j) {
    sum += weights[j] * f(times[j]);
  }
  EXPECT_NEAR(sum, F(1.12) - F(1.0), 1e-10);
}

/// A roundabout: constant speed forward, constant angular velocity.
struct Circle {
  double omega = 0.6;  // rad/s
  double speed = 8.0;  // m/s

  [[nodiscard]] VelocitySample sample(double t) const {
    VelocitySample result;
    result.time_s = t;
    result.velocity_sensor = {speed, 0.0, 0.0};
    result.covariance = Vector3d(1e-4, 4e-4, 9e-4).asDiagonal();
    result.R_map_sensor = exp_so3(omega * t * Vector3d::UnitZ());
    return result;
  }

  [[nodiscard]] Vector3d position(double t) const {
    return speed / omega * Vector3d(std::sin(omega * t), 1.0 - std::cos(omega * t), 0.0);
  }
};

Vector3d whole(const Displacement& displacement, const VelocitySample& last) {
  return displacement.fixed_map + displacement.last_weight_s * (last.R_map_sensor * last.velocity_sensor);
}

TEST(DisplacementBetween, FollowsATurnTenTimesBetterWithAThirdScan) {
  const Circle circle;
  const std::array samples = {circle.sample(0.9), circle.sample(1.0), circle.sample(1.1)};
  const Vector3d truth = circle.position(1.1) - circle.position(1.0);
  const double two = (whole(displacement_between(std::span(samples).last(2), 1.0, 1.1), samples[2]) - truth).norm();
  const double three = (whole(displacement_between(samples, 1.0, 1.1), samples[2]) - truth).norm();
  EXPECT_LT(two, 3e-4);
  EXPECT_LT(three, 3e-5);
  EXPECT_LT(three, 0.1 * two);
}

TEST(DisplacementBetween, TakesVelocitiesFromTheMiddleOfSweeps) {
  const Circle circle;
  const std::array samples = {circle.sample(0.95), circle.sample(1.05), circle.sample(1.15)};
  const Vector3d truth = circle.position(1.1) - circle.position(1.0);
  EXPECT_LT((whole(displacement_between(samples, 1.0, 1.1), samples[2]) - truth).norm(), 1e-5);
}

TEST(DisplacementBetween, CarriesTheCovarianceInMapAxes) {
  const Circle circle;
  const std::array samples = {circle.sample(0.0), circle.sample(0.1)};
  const Displacement displacement = displacement_between(samples, 0.0, 0.1);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (const VelocitySample& sample : samples) {
    expected += 0.05 * 0.05 * sample.R_map_sensor * sample.covariance * sample.R_map_sensor.transpose();
  }
  EXPECT_LT((displacement.covariance_map - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace dynamic_icp::motion
