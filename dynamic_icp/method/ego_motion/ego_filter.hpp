// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

namespace dynamic_icp::ego_motion {

/// (m/s)^2, of the Doppler error of a sensor that counts as calibrated.
inline constexpr double kCalibratedVariance = 0.005 * 0.005;

struct DriftConfig {
  double start_acceleration_mps2 = 3.0;  ///< standard deviation of the acceleration at the first scan
  double start_bias_mps = 0.2;           ///< standard deviation of the Doppler bias at the first scan
  double jerk_mps3 = 5.0;                ///< standard deviation of the change of acceleration
  double bias_drift_mps = 0.003;         ///< standard deviation of the change of the bias in one second
};

ConfigFields fields(DriftConfig& config);

/// Before the first scan.
EgoPrior first_prior(const DriftConfig& config);

/// What a scan says of one that is taken `dt_s` later: a Kalman filter's prediction of velocity, acceleration (both in
/// the axes of the sensor, which hardly turn between two scans) and bias, with a white change of acceleration. In a
/// scan that sweeps, time is azimuth, and acceleration, velocity and bias are hard to tell apart; over several scans
/// they are not.
EgoPrior predict(const EgoVelocity& ego, double dt_s, const DriftConfig& config);

/// Takes into account that the sensor may well be calibrated. The filter knows of the bias that it is about
/// `start_bias_mps` or less; half of all sensors have none at all. How much more likely that is by now follows from the
/// filter's estimate alone (Savage and Dickey): odds = N(0; bias, variance) / N(0; 0, start_bias^2). The result is the
/// mean and covariance of both cases, the filter's estimate and the same given that the bias is zero (within 5 mm/s).
/// Where velocity and bias can be distinguished this changes nothing; in a narrow view, in a jam, or in the first scan
/// of a sweep it keeps a bias that nobody has seen from spoiling the velocity.
///
/// For use, not for the filter: what it is given is to be carried on.
EgoVelocity average_over_bias_models(const EgoVelocity& filtered, const DriftConfig& config);

}  // namespace dynamic_icp::ego_motion
