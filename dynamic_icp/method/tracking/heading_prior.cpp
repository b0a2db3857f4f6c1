// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/heading_prior.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kConcentration = 1.0;  // alpha: as much as one vehicle at the same place tells
constexpr double kLaneSigma_rad = 0.1;  // of headings in the same lanes
constexpr double kNearby_m = 30.0;      // lanes bend

double yaw_in(const Matrix3d& level, const Vector3d& direction) {
  const Vector3d local = level.transpose() * direction;
  return std::atan2(local.y(), local.x());
}

double weight_of(double distance_m) { return std::exp(-0.5 * distance_m * distance_m / (kNearby_m * kNearby_m)); }

}  // namespace

double HeadingPrior::log_ratio(const Vector3d& position, const Matrix3d& level, double yaw_rad) const {
  constexpr double kPeak = std::numbers::pi / (kLaneSigma_rad * 2.5066282746310002);  // pi / (sigma sqrt(2 pi))
  double density = kConcentration;
  double total = kConcentration;
  for (const Vehicle& vehicle : vehicles_) {
    const double weight = weight_of((vehicle.position - position).norm());
    const double off = std::remainder(yaw_rad - yaw_in(level, vehicle.direction), std::numbers::pi) / kLaneSigma_rad;
    density += weight * kPeak * std::exp(-0.5 * off * off);
    total += weight;
  }
  return std::log(density / total);
}

std::optional<double> HeadingPrior::likeliest_yaw(const Vector3d& position, const Matrix3d& level) const {
  std::optional<double> best;
  double most = 0.0;
  for (const Vehicle& vehicle : vehicles_) {
    const double yaw = yaw_in(level, vehicle.direction);
    const double ratio = log_ratio(position, level, yaw);
    if (ratio > most) {
      most = ratio;
      best = yaw;
    }
  }
  return best;
}

}  // namespace dynamic_icp::tracking
