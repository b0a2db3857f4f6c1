// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::window {

/// What was learned of a sensor's Doppler over the directions it measures in: at medium range and intensity, by
/// the line that measures there and with the mean of its faces.
struct ErrorByDirection {
  std::vector<double> azimuths_rad;    ///< ascending, to the left
  std::vector<double> elevations_rad;  ///< ascending, up
  Eigen::MatrixXd error_mps;           ///< elevations x azimuths
  Eigen::MatrixXd sigma_mps;           ///< its standard deviation
};

/// Of sensor number `sensor`, at so many azimuths and elevations (the middles of equal parts of its view). Throws
/// UsageError when there is no such sensor or the parts of the calibration do not fit each other.
ErrorByDirection error_by_direction(const SensorCalibration& calibration, std::size_t sensor, std::size_t azimuths,
                                    std::size_t elevations);

/// What range adds to the error, compared with that at medium range; the same in all directions.
struct ErrorByRange {
  std::vector<double> error_mps;  ///< at each of the ranges
  std::vector<double> sigma_mps;  ///< its standard deviation, 0 at medium range
};

/// Of sensor number `sensor` at these ranges (m), as above.
ErrorByRange error_by_range(const SensorCalibration& calibration, std::size_t sensor, std::span<const double> ranges_m);

}  // namespace dynamic_icp::window
