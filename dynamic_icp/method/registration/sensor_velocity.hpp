// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/registration/residual.hpp"

namespace dynamic_icp::registration {

/// What the Doppler term of Doppler-ICP must know: clouds, lines of sight and T_target_source are in the frame of the
/// vehicle.
struct VehicleMotion {
  Eigen::Vector3d sensor_vehicle = Eigen::Vector3d::Zero();  ///< m, where the sensor sits: the lever arm
  double dt_s = 0.1;                                         ///< from the source's scan to the target's
};

/// The Doppler residual of Doppler-ICP, m/s: the measured Doppler of a source point minus the one that a static point
/// would have if the vehicle moved as T_target_source = (theta, t) says:
///   omega = -theta / dt, v_vehicle = -t / dt, v_sensor = v_vehicle + omega x r, e = s + d . v_sensor,
/// with the line of sight d as measured. The Jacobian is the published one, [d x r; -d] / dt: it takes the perturbation
/// as added to (theta, t).
inline Residual sensor_velocity(const Eigen::Vector3d& theta, const Eigen::Vector3d& translation,
                                const Eigen::Vector3d& direction, double doppler, const VehicleMotion& motion) {
  const Eigen::Vector3d velocity_sensor = (-translation - theta.cross(motion.sensor_vehicle)) / motion.dt_s;
  Residual residual;
  residual.value = doppler + direction.dot(velocity_sensor);
  residual.jacobian << direction.cross(motion.sensor_vehicle), -direction;
  residual.jacobian /= motion.dt_s;
  return residual;
}

}  // namespace dynamic_icp::registration
