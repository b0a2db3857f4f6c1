// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expectation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kGateSigmas = 2.0;
constexpr double kMaxGate_m = 2.0;
constexpr double kMaxGate_mps = 3.0;
constexpr double kWidthSlack_m = 0.1;
constexpr double kGroundClearance_m = 0.3;  // points lower in a box may be the road ...
constexpr double kGroundShare = 0.25;       // ... but at most so much of its height is left out

}  // namespace

Expectation::Expectation(const Track& predicted, const BoxEstimate& estimate, const SensorMotion& sensor,
                         const TrackerConfig& config, bool is_hidden)
    : box(predicted.best().seen_box()), whole(estimate.box), velocity(estimate.velocity) {
  const Vector3d eye = sensor.T_world_sensor.translation();
  W = predicted.body().doppler_velocity(eye);
  W_covariance = predicted.body().doppler_covariance(eye);
  const double position = std::sqrt(predicted.body().covariance().topLeftCorner<2, 2>().trace());
  gate_m = std::min(kMaxGate_m, config.gate_m + kGateSigmas * position);
  max_width_m = config.track.largest_width_m + kWidthSlack_m + kGateSigmas * position;
  gate_mps = config.gate_mps;
  if (is_hidden) {  // of what comes into view again other parts may be seen than before
    for (const int axis : {0, 1}) {
      const Vector3d along = whole.axes.col(axis);
      const double sigma = std::sqrt(along.dot(estimate.centre_covariance * along));
      whole.size[axis] += 2.0 * std::min(kMaxGate_m, kGateSigmas * sigma);
    }
  }
}

double Expectation::outside(const Vector3d& point_world, double time_s) const {
  return distance_outside(box, point_world - time_s * velocity);
}

double Expectation::distance_ratio(const Vector3d& point_world, double time_s) const {
  const Vector3d point = point_world - time_s * velocity;
  const double ratio = distance_outside(box, point) / gate_m;
  return ratio > kUnseenRatio && distance_outside(whole, point) <= 0.0 ? kUnseenRatio : ratio;
}

double Expectation::width_with(const Vector3d& point_world, double time_s) const {
  const double beside = std::abs(box.axes.col(1).dot(point_world - time_s * velocity - box.centre));
  return std::max(box.size.y(), beside + 0.5 * box.size.y());
}

double Expectation::radial_sigma(const Vector3d& direction_world) const {
  return std::sqrt(std::max(0.0, direction_world.dot(W_covariance * direction_world)));
}

double Expectation::gate_ratio(const Vector3d& direction_world, double radial_mps) const {
  const double gate = std::min(kMaxGate_mps, gate_mps + kGateSigmas * radial_sigma(direction_world));
  return std::abs(radial_mps - direction_world.dot(W)) / gate;
}

bool Expectation::excludes(const Vector3d& direction_world, double radial_mps, double same_velocity_mps) const {
  const double expected_mps = W.dot(direction_world);
  return std::abs(expected_mps) > same_velocity_mps &&
         std::abs(radial_mps - expected_mps) > same_velocity_mps + radial_sigma(direction_world);
}

bool Expectation::may_appear_static(const Vector3d& sensor_world, double slow_mps) const {
  const Vector3d to_object = box.centre - sensor_world;
  const double range = std::max(1.0, to_object.norm());
  const double difference = 0.5 * box.size.norm() / range * W.norm();  // of radial velocities within the body
  return std::abs(to_object.dot(W)) / range < slow_mps + difference;
}

OrientedBox Expectation::box_above_ground() const {
  OrientedBox above = box;
  const double clearance = std::min(kGroundClearance_m, kGroundShare * box.size.z());
  above.size.z() -= clearance;
  above.centre += 0.5 * clearance * box.axes.col(2);
  return above;
}

}  // namespace dynamic_icp::tracking
