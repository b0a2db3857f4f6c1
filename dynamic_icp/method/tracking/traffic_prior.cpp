// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/traffic_prior.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kConcentration = 1.0;  // alpha: as much as one vehicle at the same place tells
constexpr double kLaneSigma_rad = 0.1;  // of headings in the same lanes
constexpr double kNearby_m = 30.0;      // lanes bend

constexpr double kLaneSigma_mps = 3.0;  // of speeds there

double normal(double x, double sigma) {
  return std::exp(-0.5 * (x / sigma) * (x / sigma)) / (std::sqrt(2.0 * std::numbers::pi) * sigma);
}

double weight_of(double distance_m) { return std::exp(-0.5 * distance_m * distance_m / (kNearby_m * kNearby_m)); }

}  // namespace

void TrafficPrior::clear(const Matrix3d& level) {
  level_ = level;
  vehicles_.clear();
}

void TrafficPrior::add(const Vector3d& position, const Vector3d& direction, double speed_mps) {
  const Vector3d in_level = level_.transpose() * direction;
  vehicles_.push_back({position, std::atan2(in_level.y(), in_level.x()), speed_mps});
}

double TrafficPrior::log_ratio_of_heading(const Vector3d& position, double yaw_rad) const {
  const double peak = std::sqrt(0.5 * std::numbers::pi) / kLaneSigma_rad;  // of pi N
  double density = kConcentration;
  double total = kConcentration;
  for (const Vehicle& vehicle : vehicles_) {
    const double weight = weight_of((vehicle.position - position).norm());
    const double off = std::remainder(yaw_rad - vehicle.yaw_rad, std::numbers::pi) / kLaneSigma_rad;
    density += weight * peak * std::exp(-0.5 * off * off);
    total += weight;
  }
  return std::log(density / total);
}

double TrafficPrior::log_ratio_of_speed(const Vector3d& position, double speed_mps, double sigma_any_mps) const {
  const double any = 2.0 * normal(speed_mps, sigma_any_mps);
  double density = kConcentration * any;
  double total = kConcentration;
  for (const Vehicle& vehicle : vehicles_) {
    const double weight = weight_of((vehicle.position - position).norm());
    density += weight * normal(speed_mps - vehicle.speed_mps, kLaneSigma_mps);
    total += weight;
  }
  return std::log(density / (total * any));
}

std::optional<double> TrafficPrior::likeliest_yaw(const Vector3d& position) const {
  std::optional<double> best;
  double most = 0.0;
  for (const Vehicle& vehicle : vehicles_) {
    const double ratio = log_ratio_of_heading(position, vehicle.yaw_rad);
    if (ratio > most) {
      most = ratio;
      best = vehicle.yaw_rad;
    }
  }
  return best;
}

}  // namespace dynamic_icp::tracking
