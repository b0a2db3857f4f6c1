// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/ego_motion/ego_filter.hpp"

namespace dynamic_icp::ego_motion {

ConfigFields fields(DriftConfig& config) {
  return {
      {"start_acceleration_mps2", &config.start_acceleration_mps2, 1e-3, 1000.0, "m/s^2",
       "deviation of the acceleration at the first scan"},
      {"start_bias_mps", &config.start_bias_mps, 1e-6, 10.0, "m/s", "deviation of the Doppler bias at the first scan"},
      {"jerk_mps3", &config.jerk_mps3, 1e-3, 1e4, "m/s^3", "deviation of the change of the acceleration"},
      {"bias_drift_mps", &config.bias_drift_mps, 0.0, 1.0, "m/s", "deviation of the change of the bias in one second"},
  };
}

EgoPrior first_prior(const DriftConfig& config) {
  EgoPrior prior;
  prior.covariance.diagonal().segment<3>(3).setConstant(config.start_acceleration_mps2 *
                                                        config.start_acceleration_mps2);
  prior.covariance(6, 6) = config.start_bias_mps * config.start_bias_mps;
  return prior;
}

EgoPrior predict(const EgoVelocity& ego, double dt_s, const DriftConfig& config) {
  Matrix7d F = Matrix7d::Identity();
  F.block<3, 3>(0, 3) = dt_s * Eigen::Matrix3d::Identity();
  // A jerk that is even over the step: dt in the acceleration, dt^2/2 in the velocity.
  Eigen::Matrix<double, 7, 3> G = Eigen::Matrix<double, 7, 3>::Zero();
  G.topRows<3>() = 0.5 * dt_s * dt_s * Eigen::Matrix3d::Identity();
  G.middleRows<3>(3) = dt_s * Eigen::Matrix3d::Identity();

  Vector7d state;
  state << ego.velocity_sensor, ego.acceleration_sensor, ego.bias_mps;
  EgoPrior prior;
  prior.has_velocity = !ego.covariance.isZero(0.0);
  prior.mean = F * state;
  prior.covariance = F * ego.joint_covariance * F.transpose() + config.jerk_mps3 * config.jerk_mps3 * G * G.transpose();
  prior.covariance(6, 6) += config.bias_drift_mps * config.bias_drift_mps * dt_s;
  return prior;
}

}  // namespace dynamic_icp::ego_motion
