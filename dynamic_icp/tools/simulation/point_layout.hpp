// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::simulation {

/// Writes the points of scans the way the recordings of some data set hold them. Every failure of the machine is a
/// DataError that names the file and the reason.
class PointLayout {
 public:
  virtual ~PointLayout() = default;

  /// The scans of each sensor come in the order of their stamps.
  virtual void add(const SimulatedFrame& frame, std::size_t sensor) = 0;

  /// Completes the files.
  virtual void finish() {}
};

/// Stamp 0 of a simulation in layouts with Unix time: 2025-01-01 00:00:00 UTC.
constexpr std::int64_t kUnixTimeOfStart = 1'735'689'600'000'000'000;  // ns

/// The same in the layout helipr, which is told from hercules by the year: 2023-06-01 00:00:00 UTC, when its records
/// had no intensity yet.
constexpr std::int64_t kHeliprTimeOfStart = 1'685'577'600'000'000'000;  // ns

/// point_clouds/00001.bin: float32 x, y, z, Doppler. For sensors whose scans take time also times/00001.bin: float32
/// seconds after the stamp, for each point.
std::unique_ptr<PointLayout> make_dicp_layout(const std::filesystem::path& folder, bool takes_time);

/// LiDAR/Aeva/<stamp_ns>.bin in records of 29 bytes, with the reflectivity in percent, and PR_GT/Aeva_gt.txt with the
/// poses of the sensor relative to its first scan. `add` throws UsageError for sensors with more rows than fit (256).
std::unique_ptr<PointLayout> make_hercules_layout(const std::filesystem::path& folder);

/// The same in records of 25 bytes, without the intensity, and LiDAR_GT/Aeva_gt.txt. The Doppler is compensated, as in
/// the data set. Keeps a reference to the simulation.
std::unique_ptr<PointLayout> make_helipr_layout(const std::filesystem::path& folder, const Simulation& simulation);

/// aeva/<stamp_us>.bin in records of ten float32 (Boreas-RT), with the reflectivity in percent and the line among the
/// flags; applanix/aeva_poses.csv with the poses of the sensor in a frame whose origin is far from the scene. `add`
/// throws UsageError for sensors with more rows than fit (256) and for stamps that are no whole microseconds.
std::unique_ptr<PointLayout> make_boreas_layout(const std::filesystem::path& folder);

/// All sensors of the vehicle in one recording:
///   sequence.json                                    mountings; poses of the vehicle and boxes of moving bodies
///   pointcloud_raw/<sensor>_<stamp_ns>.npz           points with the Doppler as measured
///   pointcloud_compensated/<sensor>_<stamp_ns>.npz   the same points, Doppler compensated for the ego motion
/// Reflectivities, 13 bits there, are 8191 times the simulated share, at most 8191. Classes are numbers only: the names
/// beside them in the data set are objects of Python. The vehicle frame is that of the simulation, below the middle of
/// the vehicle. The sensors' scans must come frame by frame. Keeps a reference to the simulation.
std::unique_ptr<PointLayout> make_aevascenes_layout(const std::filesystem::path& folder, const Simulation& simulation);

}  // namespace dynamic_icp::simulation
