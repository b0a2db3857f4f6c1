// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::tracking {

/// Along which lines vehicles move around a place: as those near by whose headings are known, which follow the same
/// lanes, this way or the other.
///
/// The headings, taken modulo pi, are draws from an unknown distribution with a Dirichlet process of uniform base
/// measure as prior. What it predicts of the next one is
///   p(yaw) = (alpha / pi + sum_i w_i N(yaw - yaw_i; 0, sigma^2)) / (alpha + sum_i w_i),
/// and weights w_i fall with the distance.
class HeadingPrior {
 public:
  HeadingPrior() { vehicles_.reserve(kUsualVehicles); }

  /// Nothing is known. Headings are to refer to `level`: columns two directions in the ground, and its normal (Ground).
  void clear(const Eigen::Matrix3d& level);

  /// A vehicle at `position` (m, world) that moves along `direction` (world).
  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& direction);

  /// log(pi p(yaw)) at `position`: how much likelier than if all headings were alike. 0 where none is known.
  [[nodiscard]] double log_ratio(const Eigen::Vector3d& position, double yaw_rad) const;

  /// The likeliest heading, modulo pi, of those that are known; nothing where none is.
  [[nodiscard]] std::optional<double> likeliest_yaw(const Eigen::Vector3d& position) const;

 private:
  struct Vehicle {
    Eigen::Vector3d position;
    double yaw_rad;
  };

  static constexpr std::size_t kUsualVehicles = 256;  // more cost an allocation now and then

  Eigen::Matrix3d level_ = Eigen::Matrix3d::Identity();
  std::vector<Vehicle> vehicles_;
};

}  // namespace dynamic_icp::tracking
