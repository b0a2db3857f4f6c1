// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expectation.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kGateDeviations = 2.0;
constexpr double kWidestGate_m = 2.0;
constexpr double kWidestGate_mps = 3.0;

}  // namespace

Expectation::Expectation(const Track& predicted, const SensorMotion& sensor, const TrackerConfig& config)
    : box(predicted.box()), velocity(predicted.motion().velocity()) {
  const Vector3d eye = sensor.T_world_sensor.translation();
  W = predicted.motion().doppler_velocity(eye);
  W_covariance = predicted.motion().doppler_covariance(eye);
  const double position = std::sqrt(predicted.motion().covariance().topLeftCorner<2, 2>().trace());
  gate_m = std::min(kWidestGate_m, config.gate_m + kGateDeviations * position);
  gate_mps = config.gate_mps;
}

double Expectation::outside(const Vector3d& point_world, double time_s) const {
  return distance_outside(box, point_world - time_s * velocity);
}

double Expectation::deviation(const Vector3d& direction_world, double radial_mps) const {
  const double sigma = std::sqrt(std::max(0.0, direction_world.dot(W_covariance * direction_world)));
  const double gate = std::min(kWidestGate_mps, gate_mps + kGateDeviations * sigma);
  return std::abs(radial_mps - direction_world.dot(W)) / gate;
}

bool Expectation::may_look_still(const Vector3d& sensor_world, double slow_mps) const {
  const Vector3d to_object = box.centre - sensor_world;
  const double range = std::max(1.0, to_object.norm());
  const double difference = 0.5 * box.size.norm() / range * W.norm();  // of radial velocities within the body
  return velocity.norm() > slow_mps && std::abs(to_object.dot(W)) / range < slow_mps + difference;
}

}  // namespace dynamic_icp::tracking
