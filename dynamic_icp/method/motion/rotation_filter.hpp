// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/motion/rotation_filter_config.hpp"

namespace dynamic_icp::motion {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Rotation, angular velocity and acceleration of the sensor at the stamp of a scan, and how well they are known.
struct RotationState {
  Eigen::Matrix3d R_map_sensor = Eigen::Matrix3d::Identity();
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< rad/s, sensor axes
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< rad/s^2, sensor axes
  Matrix9d covariance = Matrix9d::Zero();           ///< of [rotation (map axes); omega; alpha]
  double process_noise = 1.0;  ///< variance of the angular acceleration over the configured one, as the last scans show
};

/// The state at the first scan: the map's axes are those of the sensor, nothing is known of the angular velocity.
RotationState first_rotation_state(const RotationFilterConfig& config);

/// The state `dt_s` later. The angular acceleration fades with its time constant and is driven by noise that keeps its
/// standard deviation (a first order Gauss-Markov process); rotation and angular velocity follow from it.
RotationState predict(const RotationState& state, double dt_s, const RotationFilterConfig& config);

}  // namespace dynamic_icp::motion
