// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/tools/simulation/ray_returns.hpp"
#include "dynamic_icp/tools/simulation/scan_pattern.hpp"
#include "dynamic_icp/tools/simulation/sensor_unit.hpp"

namespace dynamic_icp::simulation {

/// A scan as measured, with the truth of each point: that of the surface or drop that is seen, at an edge of the
/// stronger of two. All columns have the same length, in the order of the pattern.
struct SimulatedScan {
  RawScan measured;                  ///< in the sensor frame at each ray's own time; `times` are filled
  std::vector<float> reflectivity;   ///< of the surface, see world::TriangleMesh; 0 for rain
  std::vector<float> intensity_db;   ///< strength of the return over a 10 % surface head-on at 1 m
  std::vector<std::uint16_t> lines;  ///< row of the pattern, 0 at the top
  std::vector<std::uint8_t> beams;   ///< see PatternRay
  std::vector<std::uint8_t> faces;   ///< of the mirror
  std::vector<std::int32_t> bodies;  ///< id of the body seen; 0 static surface, kNoBody rain
  std::vector<ReturnKind> kinds;
  std::vector<double> true_range;        ///< m, of what is seen
  std::vector<double> true_doppler;      ///< m/s, of what is seen, positive away
  std::vector<double> systematic_error;  ///< m/s, the part of the Doppler's error that is no noise
};

/// Which scan of a drive it is.
struct ScanOfDrive {
  Stamp begin;                     ///< when its first ray leaves, where time 0 of the trajectories is stamp 0
  std::size_t index = 0;           ///< decides on the face where each sweeps a whole scan
  double doppler_drift_mps = 0.0;  ///< m/s, see DopplerError::drift_mps
};

/// Makes a scan. Each ray is cast at its own time with sensor and bodies as they are then; `measured.stamp` is the
/// begin. Same bits for any number of workers. Throws std::invalid_argument when a trajectory gives a pose that is not
/// finite.
SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const SensorUnit& unit,
                            const ScanOfDrive& which, const RandomSource& noise, const Workers& workers);

}  // namespace dynamic_icp::simulation
