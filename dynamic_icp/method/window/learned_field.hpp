// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/window/doppler_error_field.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::window {

/// A calibration as the estimator has it.
struct LearnedField {
  DopplerErrorField field;      ///< with the scales that were learned
  Eigen::VectorXd theta;        ///< m/s
  Eigen::MatrixXd information;  ///< (s/m)^2, of theta without its prior
  Eigen::VectorXd gradient;     ///< s/m, at theta without its prior
};

/// Whether a sensor or rig may have so many sensors, lines and faces: a field for more would fill the memory.
bool is_possible(const FieldShape& shape);

/// Throws UsageError when the parts of the calibration do not fit each other or cannot be of any sensor.
LearnedField learned_field(const SensorCalibration& calibration);

}  // namespace dynamic_icp::window
