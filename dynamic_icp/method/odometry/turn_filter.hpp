// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/odometry/turn_filter_config.hpp"
#include "dynamic_icp/method/registration/map_alignment.hpp"

namespace dynamic_icp::odometry {

/// How the sensor stands and turns at the stamp of a scan, and how well that is known.
struct TurnState {
  Eigen::Matrix3d R_map_sensor = Eigen::Matrix3d::Identity();
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();                     ///< rad/s, sensor axes
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();                     ///< rad/s^2, sensor axes
  registration::Matrix9d covariance = registration::Matrix9d::Zero();  ///< of [rotation (map axes); omega; alpha]
  double liveliness = 1.0;  ///< variance of the angular acceleration over the configured one, as the last scans show it
};

/// At the first scan: the map's axes are those of the sensor, nothing is known of the turn.
TurnState first_turn_state(const TurnFilterConfig& config);

/// `dt_s` later. The angular acceleration fades with its time constant and is driven by noise that keeps its deviation
/// (a first order Gauss-Markov process); rotation and rate follow from it.
TurnState predict(const TurnState& state, double dt_s, const TurnFilterConfig& config);

/// The state that an alignment found from a prediction. How far it is from the prediction tells how lively the turn is.
/// Within a sweep that takes `duration_s` the turn is no exact parabola: what the noise of the angular acceleration
/// leaves to the fit is added to the covariance.
TurnState turn_state(const registration::MapAlignment& alignment, const TurnState& predicted, double duration_s,
                     const TurnFilterConfig& config);

}  // namespace dynamic_icp::odometry
