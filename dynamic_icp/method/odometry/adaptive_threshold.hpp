// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::odometry {

/// How far the points at `max_range_m` are moved by the motion T at most, in metres: by its translation and by the
/// chord of its rotation, |t| + 2 max_range sin(theta/2).
double point_displacement(const Eigen::Isometry3d& T, double max_range_m);

/// The adaptive threshold of KISS-ICP: how wrong the predicted poses usually are, sigma. It is the root mean square of
/// the displacements between predicted and registered poses, as far as they exceed `min_motion_m`.
///
/// While the sensor is within five times `min_motion_m` of its first position nothing is learnt, and sigma is
/// `initial_m`; as published this also holds when it comes back there.
class AdaptiveThreshold {
 public:
  AdaptiveThreshold(double initial_m, double min_motion_m, double max_range_m)
      : initial_m_(initial_m), min_motion_m_(min_motion_m), max_range_m_(max_range_m) {}

  /// Takes the outcome of one registration: the registered pose in the predicted one, and how far the sensor is from
  /// its first position.
  void observe(const Eigen::Isometry3d& T_predicted_registered, double distance_from_first_m);

  [[nodiscard]] double sigma_m() const;

  void state(StateArchive& archive);

 private:
  double initial_m_;
  double min_motion_m_;
  double max_range_m_;
  bool has_moved_ = false;
  double sum_of_squares_ = 0.0;  ///< m^2
  std::size_t count_ = 0;
};

}  // namespace dynamic_icp::odometry
