// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::simulation {

/// Constant errors of where a point is, drawn for the unit of the sensor. Those of direction are of azimuth and
/// elevation each.
struct PointingErrorConfig {
  double line_deg = 0.0;
  double face_deg = 0.0;
  double beam_range_m = 0.0;
};

ConfigFields fields(PointingErrorConfig& config);

/// What is measured minus what is so.
struct PointingOffset {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double range_m = 0.0;
};

/// The pointing errors of one unit of a sensor.
class PointingError {
 public:
  PointingError(const PointingErrorConfig& config, const RandomSource& unit);

  [[nodiscard]] PointingOffset at(std::size_t line, std::size_t beam, std::size_t face) const;

 private:
  PointingErrorConfig config_;
  RandomSource lines_;
  RandomSource faces_;
  RandomSource beams_;
};

}  // namespace dynamic_icp::simulation
