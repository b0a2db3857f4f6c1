// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/base/scan.hpp"
#include "dynamic_icp/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/simulation/random_source.hpp"
#include "dynamic_icp/simulation/ray_caster.hpp"
#include "dynamic_icp/simulation/world.hpp"

namespace dynamic_icp::simulation {

/// A scan as measured, with the truth of each point. All columns have the same length, in the order of the pattern.
struct SimulatedScan {
  RawScan measured;                  ///< in the sensor frame at each ray's own time; `times` are filled
  std::vector<std::int32_t> bodies;  ///< id of the body that was met; 0 on the static surface
  std::vector<double> true_range;    ///< m
  std::vector<double> true_doppler;  ///< m/s, positive away
};

/// The true range rate (m/s, positive away) of a surface point seen along `direction_world`:
/// s = u . (v_point - v_sensor), where v_sensor has the lever arm of the mounting (`mounted`) and v_point the rotation
/// of the body the point belongs to.
double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const MotionState& sensor);

/// What scanning needs to know besides the sensor.
struct Surroundings {
  const World& world;
  const RayCaster& caster;
  const Trajectory& sensor;  ///< of the sensor frame
};

/// Makes the scan that begins at `stamp`, where time 0 of the trajectories is stamp 0. Each ray is cast at its own time
/// with sensor and bodies as they are then. Same bits for any number of workers.
/// Throws std::invalid_argument when a trajectory gives a pose that is not finite.
SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const FmcwLidarConfig& config,
                            Stamp stamp, const RandomSource& noise, const Workers& workers);

}  // namespace dynamic_icp::simulation
