// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/map_writer.hpp"

#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxVoxels = 1 << 30;  // from the origin along an axis, see VoxelHashMap

double checked(double voxel_size_m) {
  if (!(voxel_size_m >= MapWriter::kMinVoxelSize_m && voxel_size_m <= MapWriter::kMaxVoxelSize_m)) {
    throw UsageError(fmt::format("the voxels of the map are {} m wide, expected {} to {} m", voxel_size_m,
                                 MapWriter::kMinVoxelSize_m, MapWriter::kMaxVoxelSize_m));
  }
  return voxel_size_m;
}

/// The path without links, as far as it exists.
fs::path resolved(const fs::path& path) {
  std::error_code fault;
  const fs::path canonical = fs::weakly_canonical(fs::absolute(path), fault);
  return fault ? fs::absolute(path).lexically_normal() : canonical;
}

}  // namespace

void check_map_file(const fs::path& path) {
  if (path.extension() != ".ply" && path.extension() != ".pcd") {
    throw UsageError(
        fmt::format("'{}' cannot be a map: expected a file name that ends in .ply or .pcd", path.string()));
  }
}

fs::path map_destination(const fs::path& path, const fs::path& output, const fs::path& staging) {
  const fs::path within = resolved(path).lexically_relative(resolved(output));
  if (within == ".") {
    throw UsageError(fmt::format("'{}' is to be the folder of the run and its map, expected two names", path.string()));
  }
  if (!within.empty() && *within.begin() != "..") {
    formats::make_folder((staging / within).parent_path());
    return staging / within;
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw DataError(fmt::format("{}: cannot create: it is a folder", path.string()));
  }
  if (!fs::is_directory(fs::absolute(path).parent_path(), ignored)) {
    throw DataError(fmt::format("{}: cannot create: its folder does not exist", path.string()));
  }
  return path;
}

MapWriter::MapWriter(double voxel_size_m) : voxel_size_m_(checked(voxel_size_m)), voxels_(voxel_size_m, 1) {}

void MapWriter::add(const odometry::Frame& frame) {
  std::vector<Eigen::Vector3d> in_world;
  in_world.reserve(frame.static_points.size());
  for (const Eigen::Vector3d& point : frame.static_points) {
    in_world.emplace_back(frame.T_world_sensor * point);
    // Written so that NaN fails as well. One voxel is kept in hand for rounding.
    if (!((in_world.back().array().abs() < (kMaxVoxels - 1.0) * voxel_size_m_).all())) {
      throw DataError(
          fmt::format("the scan at {} s has a static point that lies {} m from the first scan: too far out "
                      "for a map of voxels of {} m",
                      format_seconds(frame.stamp), in_world.back().norm(), voxel_size_m_));
    }
  }
  voxels_.add(in_world);
}

void MapWriter::write(const fs::path& path) const {
  check_map_file(path);
  const std::vector<formats::NamedArray> table = formats::point_table(voxels_.points());
  formats::write_whole_file(path, path.extension() == ".ply" ? formats::ply_bytes(table) : formats::pcd_bytes(table));
}

}  // namespace dynamic_icp::runs
