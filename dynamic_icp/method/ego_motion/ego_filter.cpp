// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::ego_motion {
namespace {

/// Logarithm of the normal density at a distance from its mean, without the constant that cancels.
double log_density(double distance, double variance) {
  return -0.5 * (distance * distance / variance + std::log(variance));
}

}  // namespace

ConfigFields fields(DriftConfig& config) {
  return {
      {"start_acceleration_mps2", &config.start_acceleration_mps2, 1e-3, 1000.0, "m/s^2",
       "standard deviation of the acceleration at the first scan"},
      {"start_bias_mps", &config.start_bias_mps, 1e-6, 10.0, "m/s",
       "standard deviation of the Doppler bias at the first scan"},
      {"jerk_mps3", &config.jerk_mps3, 1e-3, 1e4, "m/s^3", "standard deviation of the change of the acceleration"},
      {"bias_drift_mps", &config.bias_drift_mps, 0.0, 1.0, "m/s",
       "standard deviation of the change of the bias in one second"},
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

EgoVelocity average_over_bias_models(const EgoVelocity& filtered, const DriftConfig& config) {
  const double variance = filtered.bias_variance;
  if (!(variance > 0.0)) {
    return filtered;
  }
  const double presumed = config.start_bias_mps * config.start_bias_mps;
  const double log_odds = log_density(filtered.bias_mps, variance + kCalibratedVariance) - log_density(0.0, presumed);
  const double probability = 1.0 / (1.0 + std::exp(std::clamp(-log_odds, -50.0, 50.0)));

  // Given that the bias is zero, the rest follows along its regression on the bias.
  const Vector7d gain = filtered.joint_covariance.col(6) / filtered.joint_covariance(6, 6);
  const Vector7d apart = -filtered.bias_mps * gain;
  const double known = std::min(variance, kCalibratedVariance);
  EgoVelocity weighed = filtered;
  weighed.velocity_sensor += probability * apart.head<3>();
  weighed.acceleration_sensor += probability * apart.segment<3>(3);
  weighed.bias_mps += probability * apart[6];
  weighed.joint_covariance += probability * (known - variance) * gain * gain.transpose() +
                              probability * (1.0 - probability) * apart * apart.transpose();
  weighed.covariance = weighed.joint_covariance.topLeftCorner<3, 3>();
  weighed.bias_variance = weighed.joint_covariance(6, 6);
  return weighed;
}

}  // namespace dynamic_icp::ego_motion
