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
// While it is there its points are not the road, but for the noise.
constexpr double kRoadNoise_m = 0.05;
// A body that is slow is known to move so late.
constexpr double kKnownAfter_s = 1.0;
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

/// The box of an object in the world, with a halo at its sides and above. The lowest `road_m` may be the road.
tracking::OrientedBox place_of(const tracking::TrackedObject& object, double road_m,
                               const Eigen::Isometry3d& T_world_sensor) {
  tracking::OrientedBox place = object.box;
  place.size.head<2>().array() += 2.0 * kHalo_m;
  place.size.z() += kHalo_m - road_m;
  place.centre = T_world_sensor * Eigen::Vector3d(place.centre + 0.5 * (kHalo_m + road_m) * place.axes.col(2));
  place.axes = T_world_sensor.linear() * place.axes;
  return place;
}

/// How high above the bottom of its box the road may be, in other scans than the one that sees the object there.
double road_below(const tracking::TrackedObject& object) { return kRoad_m + kRoadGrowth * object.box.centre.norm(); }

bool holds(const tracking::OrientedBox& place, const Eigen::Vector3d& point) {
  return !(tracking::distance_outside(place, point) > 0.0);
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
  std::vector<tracking::OrientedBox> taken;
  for (const tracking::TrackedObject& object : frame.tracked) {
    taken.push_back(place_of(object, kRoadNoise_m, frame.T_world_sensor));
  }
  std::vector<Eigen::Vector3d> in_world;
  in_world.reserve(frame.static_points.size());
  for (const Eigen::Vector3d& point_sensor : frame.static_points) {
    const Eigen::Vector3d point = frame.T_world_sensor * point_sensor;
    // Written so that NaN fails as well. One voxel is kept in hand for rounding.
    if (!((point.array().abs() < (kMaxVoxels - 1.0) * voxel_size_m_).all())) {
      throw DataError(
          fmt::format("the scan at {} s has a static point that lies {} m from the first scan: too far out "
                      "for a map of voxels of {} m",
                      format_seconds(frame.stamp), point.norm(), voxel_size_m_));
    }
    if (std::ranges::none_of(taken, [&](const tracking::OrientedBox& place) { return holds(place, point); })) {
      in_world.push_back(point);
    }
  }
  const std::size_t before = voxels_.size();
  voxels_.add(in_world);
  is_ghost_.resize(voxels_.size(), 0);
  for (std::size_t i = before; i < voxels_.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    regions_[region_of(voxels_.point(index))].push_back(index);
  }
  std::erase_if(recent_scans_,
                [&](const auto& scan) { return seconds_between(scan.first, frame.stamp) > kKnownAfter_s; });
  std::vector<std::int64_t> movers;
  for (const tracking::TrackedObject& object : frame.tracked) {
    const bool moves =
        object.scans_seen >= kScansSeen && object.tangential_observed && object.velocity_sensor.norm() > kMinSpeed_mps;
    const bool is_known = std::ranges::find(movers_, object.id) != movers_.end();
    if (moves && !is_known) {
      take_out_before(object, frame);
    }
    if (moves || is_known) {
      movers.push_back(object.id);
      take_out(object, frame.T_world_sensor);
    }
  }
  movers_ = std::move(movers);
  recent_scans_.emplace_back(frame.stamp, static_cast<std::uint32_t>(before));
}

/// What it left where it was while it passed for static: of each scan the points in its box as that was then.
void MapWriter::take_out_before(const tracking::TrackedObject& object, const odometry::Frame& frame) {
  const tracking::OrientedBox now = place_of(object, road_below(object), frame.T_world_sensor);
  const Eigen::Vector3d velocity = frame.T_world_sensor.linear() * object.velocity_sensor;
  for (std::size_t scan = 0; scan < recent_scans_.size(); ++scan) {
    tracking::OrientedBox then = now;
    then.centre -= seconds_between(recent_scans_[scan].first, frame.stamp) * velocity;
    const std::size_t end = scan + 1 < recent_scans_.size() ? recent_scans_[scan + 1].second : voxels_.size();
    for (std::size_t i = recent_scans_[scan].second; i < end; ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      if (holds(then, voxels_.point(index))) {
        mark_ghost(index);
      }
    }
  }
}

void MapWriter::mark_ghost(std::uint32_t index) {
  ghosts_ += is_ghost_[index] == 0 ? 1U : 0U;
  is_ghost_[index] = 1;
}

/// The points in the box of an object.
void MapWriter::take_out(const tracking::TrackedObject& object, const Eigen::Isometry3d& T_world_sensor) {
  const tracking::OrientedBox place = place_of(object, road_below(object), T_world_sensor);
  if (!(place.size.minCoeff() > 0.0)) {
    return;
  }
  const Eigen::Vector3d reach = 0.5 * tracking::aligned_extent(place);
  const Eigen::Array3d low = ((place.centre - reach) / kRegion_m).array().floor();
  const Eigen::Array3d high = ((place.centre + reach) / kRegion_m).array().floor();
  for (double x = low.x(); x <= high.x(); ++x) {
    for (double y = low.y(); y <= high.y(); ++y) {
      for (double z = low.z(); z <= high.z(); ++z) {
        const auto region = regions_.find(region_of(kRegion_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
        if (region == regions_.end()) {
          continue;
        }
        std::erase_if(region->second, [&](std::uint32_t index) {
          const bool is_left = holds(place, voxels_.point(index));
          if (is_left) {
            mark_ghost(index);
          }
          return is_left;
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
  archive(voxels_, regions_, is_ghost_, ghosts_, movers_, recent_scans_);
  const auto are_points = [&](const auto& region) {
    return std::ranges::all_of(region.second, [&](std::uint32_t index) { return index < voxels_.size(); });
  };
  archive.require(
      is_ghost_.size() == voxels_.size() && ghosts_ <= voxels_.size() && std::ranges::all_of(regions_, are_points) &&
          std::ranges::all_of(recent_scans_, [&](const auto& scan) { return scan.second <= voxels_.size(); }),
      "a point of the map");
}

}  // namespace dynamic_icp::runs
