// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/ego_motion/rig_regression.hpp"
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

/// The state after an alignment that took `predicted` as its prior and found `found`. Its distance from the prediction,
/// as a normalised innovation squared, adapts the process noise. Within a sweep that takes `duration_s` the rotation is
/// no exact parabola: what the noise of the angular acceleration leaves to the fit is added to the covariance.
RotationState updated(RotationState found, const RotationState& predicted, double duration_s,
                      const RotationFilterConfig& config);

/// The state with what the Doppler of a rig says of the angular velocity `after_s` later (rig_regression.hpp).
RotationState fused(const RotationState& state, double after_s, const ego_motion::AngularInformation& doppler);

// Standard deviation of the error at the begin of a sweep of 1 s (angle, rad, and angular velocity, rad/s) of
// a parabola that least squares fit to a rotation angle whose acceleration does a random walk of 1 rad/s^2 over the
// sweep: sqrt(1/9240) and sqrt(52/3465) where the points are spread evenly over the sweep, here by simulation. Over
// another duration they grow with its square and with the duration.
inline constexpr double kParabolaMisfit_rad = 0.0102;
inline constexpr double kParabolaMisfit_rad_s = 0.12;

}  // namespace dynamic_icp::motion
