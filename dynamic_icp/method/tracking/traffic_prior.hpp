// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// How vehicles move around a place: along the same lines, this way or the other, and as fast as those near by, which
/// follow the same lanes.
///
/// Headings, taken modulo pi, and speeds are draws from unknown distributions with Dirichlet processes as priors. What
/// these predict of the next one is
///   p(yaw) = (alpha / pi + sum_i w_i N(yaw - yaw_i; 0, sigma_yaw^2)) / (alpha + sum_i w_i),
///   p(v)   = (alpha 2 N(v; 0, sigma_any^2) + sum_i w_i N(v - v_i; 0, sigma_v^2)) / (alpha + sum_i w_i),
/// and weights w_i fall with the distance.
class TrafficPrior {
 public:
  TrafficPrior() { vehicles_.reserve(kUsualVehicles); }

  /// Nothing is known. Headings are to refer to `level`: columns two directions in the ground, and its normal (Ground).
  void clear(const Eigen::Matrix3d& level);

  /// A vehicle at `position` (m, world) that points along `direction` (world).
  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& direction, double speed_mps);

  /// log(pi p(yaw)) at `position`: how much likelier than if all headings were alike. 0 where none is known.
  [[nodiscard]] double log_ratio_of_heading(const Eigen::Vector3d& position, double yaw_rad) const;

  /// log(p(v) / (2 N(v; 0, sigma_any^2))) at `position`: how much likelier than without the others.
  [[nodiscard]] double log_ratio_of_speed(const Eigen::Vector3d& position, double speed_mps,
                                          double sigma_any_mps) const;

  /// The likeliest heading, modulo pi, of those that are known; nothing where none is.
  [[nodiscard]] std::optional<double> likeliest_yaw(const Eigen::Vector3d& position) const;

 private:
  struct Vehicle {
    Eigen::Vector3d position;
    double yaw_rad;
    double speed_mps;
  };

  static constexpr std::size_t kUsualVehicles = 256;  // more cost an allocation now and then

  Eigen::Matrix3d level_ = Eigen::Matrix3d::Identity();
  std::vector<Vehicle> vehicles_;
};

}  // namespace dynamic_icp::tracking
