// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// Throws UsageError unless the file's name ends in .ply or .pcd: a map is written as one of them.
void check_map_file(const std::filesystem::path& path);

/// Where to write a file at `path`, the run's `what`, of a run whose folder `output` is put together in `staging` (see
/// formats/output_folder): one within `output` goes to its place in `staging`, any other one to `path`. Throws
/// UsageError when both are the same, and DataError when the file's folder is not there and is no part of the run's, or
/// there is a folder of the file's name.
std::filesystem::path map_destination(const std::filesystem::path& path, const std::filesystem::path& output,
                                      const std::filesystem::path& staging, const char* what = "map");

/// Collects the static points of a run in world axes: of each voxel the first point that falls into it. Where a tracked
/// object drives nothing static can stand: points in its box are left out, and what it left there, or where it was in
/// the second before it was known, is taken out again. The memory it takes (about 110 bytes a voxel) grows with the
/// scene and not with the time spent in it; the points and their order depend on the frames alone.
class MapWriter {
 public:
  static constexpr double kMinVoxelSize_m = 0.01;
  static constexpr double kMaxVoxelSize_m = 100.0;

  /// Throws UsageError unless the edge of a voxel lies between these two.
  explicit MapWriter(double voxel_size_m);

  /// Adds the static points of a frame at its pose. Throws DataError naming the time of the scan when a point lies too
  /// far out for voxels to be counted (2^30 of them) or nowhere; nothing of the frame is added then.
  void add(const odometry::Frame& frame);

  [[nodiscard]] std::size_t size() const { return voxels_.size() - ghosts_; }

  /// The points, m, world axes, by their age.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;

  /// Writes one point cloud of float32 x, y, z (m), by the age of the points, as the ending of the file says: whole or
  /// not at all. Throws as `check_map_file` does, and DataError naming file and reason when the machine fails.
  void write(const std::filesystem::path& path) const;

  void state(StateArchive& archive);

 private:
  void mark_ghost(std::uint32_t index);
  void take_out(const tracking::TrackedObject& object, const Eigen::Isometry3d& T_world_sensor);
  void take_out_before(const tracking::TrackedObject& object, const odometry::Frame& frame);

  double voxel_size_m_;
  spatial::VoxelHashMap voxels_;
  std::map<std::uint64_t, std::vector<std::uint32_t>> regions_;  ///< points by cubes of a few metres
  std::vector<std::uint8_t> is_ghost_;                           ///< of each point
  std::size_t ghosts_ = 0;
  std::vector<std::int64_t> movers_;                           ///< ids of tracked objects that moved for sure
  std::vector<std::pair<Stamp, std::uint32_t>> recent_scans_;  ///< of the last second, with the first point of each
};

}  // namespace dynamic_icp::runs
