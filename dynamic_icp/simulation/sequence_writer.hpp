// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "dynamic_icp/simulation/simulation.hpp"

namespace dynamic_icp::simulation {

/// What was written, for a summary.
struct SequenceCounts {
  std::size_t scans = 0;
  std::size_t points = 0;
  std::size_t moving_points = 0;
  std::size_t objects = 0;     ///< object records: one object in two scans counts twice
  double path_length_m = 0.0;  ///< of the sensor, from scan to scan
};

/// Writes a sequence scan by scan in the plain layout with its truth (docs/simulator.md):
///   point_clouds/00001.bin  float32 x, y, z (m, sensor frame), Doppler (m/s, positive away), little-endian
///   ref_poses.txt           TUM rows of T_world_sensor, first pose identity
///   labels/00001.bin        int32 per point: 0 at rest, > 0 the id of the moving body
///   objects.jsonl           moving bodies of each scan
///   ego.jsonl               velocity and angular velocity of the sensor at each scan
///   scene.json              what was simulated; written last
/// Every failure of the machine is a DataError that names the file and the reason.
class SequenceWriter {
 public:
  /// Writes into an existing, empty folder.
  explicit SequenceWriter(const std::filesystem::path& folder);

  void add(const SimulatedFrame& frame);

  /// Completes the files and writes scene.json. Nothing can be added afterwards.
  void finish(const Simulation& simulation, std::string_view version);

  [[nodiscard]] const SequenceCounts& counts() const { return counts_; }

 private:
  /// A text file that grows line by line.
  struct LineFile {
    std::filesystem::path path;
    std::ofstream stream;
  };

  static LineFile open(const std::filesystem::path& path);
  static void write(LineFile& file, std::string_view line);
  static void close(LineFile& file);

  void add_pose(const SimulatedFrame& frame);
  void add_objects(const SimulatedFrame& frame);
  void add_ego(const SimulatedFrame& frame);

  std::filesystem::path folder_;
  LineFile poses_;
  LineFile objects_;
  LineFile ego_;
  Eigen::Isometry3d T_first_world_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
  SequenceCounts counts_;
};

}  // namespace dynamic_icp::simulation
