// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"

// What the kernels work on: instant scans of the simulated city (seed 31) with the sensor noise of docs/benchmarks.md,
// made in this process, once, when they are first asked for.
namespace dynamic_icp::kernels {

/// Rays of the default sensor, of a small and of a large one; the scans have some 8 % fewer points.
enum class Sensor { kSmall, kUsual, kLarge };
inline constexpr std::size_t kSensors = 3;

/// Consecutive scans in the middle of the drive.
inline constexpr std::size_t kScans = 11;

/// A scan with what is known of it.
struct KnownScan {
  RawScan raw;
  Scan whole;                                                        ///< in range
  Scan thinned;                                                      ///< by the voxel grid of 0.3 m
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();         ///< m/s, true
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< true
  std::vector<double> radial;           ///< of each point of `whole`: Doppler without the sensor's own motion, m/s
  std::vector<std::uint8_t> is_moving;  ///< of each point of `whole`
  Scan still;                           ///< the points of `thinned` that do not move
};

/// Scan `index` below `kScans`. The reference stays valid.
const KnownScan& known_scan(Sensor sensor = Sensor::kUsual, std::size_t index = 0);

/// `count` points, evenly spread over the scan as read of the large sensor.
std::vector<Eigen::Vector3d> spread_points(std::size_t count);

/// The still points of a scan in world axes.
std::vector<Eigen::Vector3d> still_in_world(const KnownScan& scan);

/// The map after all scans but the last.
const mapping::PlaneMap& known_map();

}  // namespace dynamic_icp::kernels
