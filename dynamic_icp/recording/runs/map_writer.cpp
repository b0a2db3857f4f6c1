// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/map_writer.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxVoxels = 1 << 30;  // from the origin along an axis, see VoxelHashMap

constexpr double kRegion_m = 4.0;
// What a body leaves behind lies in its box or so near to it, but not on the road, which is known the less the farther
// away it is.
constexpr double kHalo_m = 0.15;
constexpr double kRoad_m = 0.1;
constexpr double kRoadGrowth = 0.004;  // m per metre of range
// An object clears its place once it has been seen so often, moves so fast and its motion is known; later also when it
// is slower.
constexpr int kScansSeen = 3;
constexpr double kMinSpeed_mps = 1.0;

std::uint64_t region_of(const Eigen::Vector3d& point) { return spatial::clamped_cell_key(point / kRegion_m); }

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

fs::path map_destination(const fs::path& path, const fs::path& output, const fs::path& staging, const char* what) {
  const fs::path within = resolved(path).lexically_relative(resolved(output));
  if (within == ".") {
    throw UsageError(
        fmt::format("'{}' is to be the folder of the run and its {}, expected two names", path.string(), what));
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
  const std::size_t before = voxels_.size();
  voxels_.add(in_world);
  is_ghost_.resize(voxels_.size(), 0);
  for (std::size_t i = before; i < voxels_.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    regions_[region_of(voxels_.point(index))].push_back(index);
  }
  std::vector<std::int64_t> movers;
  for (const tracking::TrackedObject& object : frame.tracked) {
    const bool moves =
        object.scans_seen >= kScansSeen && object.tangential_observed && object.velocity_sensor.norm() > kMinSpeed_mps;
    if (moves || std::ranges::find(movers_, object.id) != movers_.end()) {
      movers.push_back(object.id);
      take_out(object, frame.T_world_sensor);
    }
  }
  movers_ = std::move(movers);
}

/// The points in the box of an object.
void MapWriter::take_out(const tracking::TrackedObject& object, const Eigen::Isometry3d& T_world_sensor) {
  tracking::OrientedBox box = object.box;
  box.size.head<2>().array() += 2.0 * kHalo_m;
  const double road_m = kRoad_m + kRoadGrowth * box.centre.norm();
  box.size.z() += kHalo_m - road_m;
  box.centre = T_world_sensor * Eigen::Vector3d(box.centre + 0.5 * (kHalo_m + road_m) * box.axes.col(2));
  box.axes = T_world_sensor.linear() * box.axes;
  if (!(box.size.minCoeff() > 0.0)) {
    return;
  }
  const Eigen::Vector3d reach = 0.5 * tracking::aligned_extent(box);
  const Eigen::Array3d low = ((box.centre - reach) / kRegion_m).array().floor();
  const Eigen::Array3d high = ((box.centre + reach) / kRegion_m).array().floor();
  for (double x = low.x(); x <= high.x(); ++x) {
    for (double y = low.y(); y <= high.y(); ++y) {
      for (double z = low.z(); z <= high.z(); ++z) {
        const auto region = regions_.find(region_of(kRegion_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
        if (region == regions_.end()) {
          continue;
        }
        std::erase_if(region->second, [&](std::uint32_t index) {
          if (tracking::distance_outside(box, voxels_.point(index)) > 0.0) {
            return false;
          }
          is_ghost_[index] = 1;
          ++ghosts_;
          return true;
        });
      }
    }
  }
}

std::vector<Eigen::Vector3d> MapWriter::points() const {
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
    if (is_ghost_[i] == 0) {
      points.push_back(voxels_.point(i));
    }
  }
  return points;
}

void MapWriter::write(const fs::path& path) const {
  check_map_file(path);
  const std::vector<formats::NamedArray> table = formats::point_table(points());
  formats::write_whole_file(path, path.extension() == ".ply" ? formats::ply_bytes(table) : formats::pcd_bytes(table));
}

void MapWriter::state(StateArchive& archive) {
  archive(voxels_, regions_, is_ghost_, ghosts_, movers_);
  const auto are_points = [&](const auto& region) {
    return std::ranges::all_of(region.second, [&](std::uint32_t index) { return index < voxels_.size(); });
  };
  archive.require(
      is_ghost_.size() == voxels_.size() && ghosts_ <= voxels_.size() && std::ranges::all_of(regions_, are_points),
      "a point of the map");
}

}  // namespace dynamic_icp::runs
