// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/pointing_error.hpp"

#include "dynamic_icp/tools/simulation/random_streams.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {

ConfigFields fields(PointingErrorConfig& config) {
  return {
      {"line_deg", &config.line_deg, 0.0, 10.0, "deg",
       "standard deviation between lines of the measured azimuth and elevation"},
      {"face_deg", &config.face_deg, 0.0, 10.0, "deg", "the same between faces of the mirror"},
      {"beam_range_m", &config.beam_range_m, 0.0, 10.0, "m", "standard deviation between beams of the range"},
  };
}

PointingError::PointingError(const PointingErrorConfig& config, const RandomSource& unit)
    : config_(config),
      lines_(unit.fork(kLinePointing)),
      faces_(unit.fork(kFacePointing)),
      beams_(unit.fork(kBeamRange)) {}

PointingOffset PointingError::at(std::size_t line, std::size_t beam, std::size_t face) const {
  PointingOffset offset;
  const auto turn = [&](double sigma_deg, const RandomSource& random, std::size_t index) {
    if (sigma_deg > 0.0) {
      offset.azimuth_rad += kRadians * sigma_deg * random.normal(2 * index);
      offset.elevation_rad += kRadians * sigma_deg * random.normal(2 * index + 1);
    }
  };
  turn(config_.line_deg, lines_, line);
  turn(config_.face_deg, faces_, face);
  if (config_.beam_range_m > 0.0) {
    offset.range_m = config_.beam_range_m * beams_.normal(beam);
  }
  return offset;
}

}  // namespace dynamic_icp::simulation
