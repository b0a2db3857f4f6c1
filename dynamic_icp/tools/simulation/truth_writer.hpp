// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::simulation {

struct TruthOptions {
  std::int64_t epoch_ns = 0;   ///< added to every stamp
  bool vehicle_poses = false;  ///< ref_poses.txt with poses of the vehicle, and calibration.json
  bool point_truth = false;    ///< truth/
};

/// Writes what is true about the scans of one sensor:
///   ref_poses.txt      TUM rows of T_world_sensor at each scan's begin, first pose identity
///   ego.jsonl          velocity and angular velocity of the sensor at each scan's begin
///   motion.csv         pose and velocities of the sensor 20 times a scan
///   objects.jsonl      moving bodies of each scan
///   labels/00001.bin   int32 per point: 0 at rest, > 0 the id of the moving body, -1 rain
///   stamps.csv         only where stamps err: what the sensor says and when the scan began
/// On request:
///   truth/00001.bin          float64 true range (m) and true Doppler (m/s) per point
///   doppler_error/00001.bin  only where there is one: float64 error (m/s) of the Doppler that is no noise, per point
/// Rows of scans have the stamps that the sensor gave them and count the scans that are there. motion.csv is on the
/// clock of the drive and has lost scans, too.
class TruthWriter {
 public:
  /// Writes into an existing folder. Keeps a reference to the simulation.
  TruthWriter(const std::filesystem::path& folder, const Simulation& simulation, std::size_t sensor,
              const TruthOptions& options);

  void add(const SimulatedFrame& frame);
  void finish();

 private:
  void add_pose(const SimulatedFrame& frame);
  void add_objects(const SimulatedFrame& frame);
  void add_ego(const SimulatedFrame& frame);
  void add_motion_until(std::size_t scan);
  [[nodiscard]] Stamp written_stamp(const SimulatedFrame& frame) const;
  [[nodiscard]] std::string line_start(const SimulatedFrame& frame) const;

  std::filesystem::path folder_;
  const Simulation& simulation_;
  std::size_t sensor_;
  TruthOptions options_;
  formats::OutputFile poses_;
  formats::OutputFile ego_;
  formats::OutputFile motion_;
  formats::OutputFile objects_;
  std::optional<formats::OutputFile> stamps_;
  bool systematic_error_;
  Eigen::Isometry3d T_first_world_ = Eigen::Isometry3d::Identity();
  std::size_t scans_ = 0;
  std::size_t motion_scans_ = 0;  ///< lost scans among them
};

/// Labels of a scan: ids of bodies that stand now become 0.
std::vector<std::int32_t> labels_of(const SimulatedFrame& frame);

}  // namespace dynamic_icp::simulation
