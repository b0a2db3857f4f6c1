// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/tools/simulation/scan_pattern.hpp"
#include "dynamic_icp/tools/world/ray_caster.hpp"
#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::simulation {

/// What gave a return.
enum class ReturnKind : std::uint8_t {
  kSurface,  ///< one surface
  kMixed,    ///< two surfaces in one beam; the point lies between them
  kRain      ///< a drop
};

/// Label of returns that belong to no body and to no static surface.
constexpr std::int32_t kNoBody = -1;

/// A scan as measured, with the truth of each point: that of the surface or drop that is seen, at an edge of the
/// stronger of two. All columns have the same length, in the order of the pattern.
struct SimulatedScan {
  RawScan measured;                  ///< in the sensor frame at each ray's own time; `times` are filled
  std::vector<float> reflectivity;   ///< of the surface, see world::TriangleMesh; 0 for rain
  std::vector<float> intensity_db;   ///< strength of the return over a 10 % surface head-on at 1 m
  std::vector<std::uint16_t> lines;  ///< row of the pattern, 0 at the top
  std::vector<std::int32_t> bodies;  ///< id of the body seen; 0 static surface, kNoBody rain
  std::vector<ReturnKind> kinds;
  std::vector<double> true_range;    ///< m, of what is seen
  std::vector<double> true_doppler;  ///< m/s, of what is seen, positive away
};

/// The true range rate (m/s, positive away) of a surface point seen along `direction_world`:
/// s = u . (v_point - v_sensor), where v_sensor has the lever arm of the mounting (`world::mounted`) and v_point the
/// rotation of the body the point belongs to.
double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const world::MotionState& sensor);

/// What scanning needs to know besides the sensor.
struct Surroundings {
  const world::World& world;
  const world::RayCaster& caster;
  const world::Trajectory& sensor;  ///< of the sensor frame
};

/// Makes the scan that begins at `stamp`, where time 0 of the trajectories is stamp 0. Each ray is cast at its own time
/// with sensor and bodies as they are then. Same bits for any number of workers.
/// Throws std::invalid_argument when a trajectory gives a pose that is not finite.
SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const FmcwLidarConfig& config,
                            Stamp stamp, const RandomSource& noise, const Workers& workers);

}  // namespace dynamic_icp::simulation
