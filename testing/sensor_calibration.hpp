// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "dynamic_icp/method/window/doppler_error_field.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::window {

/// Some errors, known as well as `information` says.
inline SensorCalibration calibration_of(const FieldShape& shape, const Eigen::VectorXd& theta,
                                        const Eigen::MatrixXd& information) {
  SensorCalibration calibration;
  calibration.shape = shape;
  calibration.stamp_sigma_s = 1e-4;
  calibration.scan_error_mps = 1e-3;
  const DopplerErrorField field(shape);
  for (const DopplerErrorField::Group& group : field.groups()) {
    SensorCalibration::Part part{std::string(group.name), 0.1, {}, {}};
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(group.begin + i);
      part.error_mps.push_back(theta[at]);
      part.sigma_mps.push_back(1.0 / std::sqrt(information(at, at)));
    }
    calibration.parts.push_back(part);
  }
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    calibration.information.emplace_back(information.row(i).begin(), information.row(i).begin() + i + 1);
  }
  calibration.gradient.assign(static_cast<std::size_t>(theta.size()), 0.0);
  return calibration;
}

/// 0.1 m/s too much on the left, too little on the right, known well.
inline SensorCalibration half_and_half() {
  FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.2, 0.3}};
  const DopplerErrorField field(shape);
  const auto n = static_cast<Eigen::Index>(field.size());
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(n);
  for (const DopplerErrorField::Group& group : field.groups()) {
    if (group.name == "azimuth") {
      const auto half = static_cast<Eigen::Index>(group.size() / 2);
      theta.segment(static_cast<Eigen::Index>(group.begin), half).setConstant(-0.1);
      theta.segment(static_cast<Eigen::Index>(group.begin) + half, half).setConstant(0.1);
    }
  }
  return calibration_of(shape, theta, 1e4 * Eigen::MatrixXd::Identity(n, n));
}

}  // namespace dynamic_icp::window
