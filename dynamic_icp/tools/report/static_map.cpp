// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/static_map.hpp"

#include "dynamic_icp/method/spatial/space_order.hpp"

namespace dynamic_icp::report {

StaticMap::StaticMap(std::size_t max_points) : max_points_(max_points), voxels_(kFinestCell_m, 1) {}

void StaticMap::add(std::span<const Eigen::Vector3d> points, const Eigen::Isometry3d& T_world_sensor) {
  constexpr double kReach_m = 1e8;  // cells can be counted up to there
  std::vector<Eigen::Vector3d> in_world;
  in_world.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = T_world_sensor * point;
    if ((p.array().abs() < kReach_m).all()) {
      in_world.push_back(p);
    }
  }
  voxels_.add(in_world);
  limit(max_points_);
}

void StaticMap::limit(std::size_t max_points) {
  constexpr double kGrowth = 1.25;
  constexpr double kCoarsest_m = 1e6;  // one cell for all that was seen: an empty limit cannot be kept
  while (voxels_.size() > max_points && cell_m_ < kCoarsest_m) {
    cell_m_ *= kGrowth;
    spatial::VoxelHashMap coarser(cell_m_, 1);
    coarser.add(voxels_.points());
    voxels_ = std::move(coarser);
  }
}

std::vector<Eigen::Vector3d> StaticMap::points() const {
  const std::vector<Eigen::Vector3d> by_age = voxels_.points();
  std::vector<Eigen::Vector3d> ordered;
  ordered.reserve(by_age.size());
  for (const std::uint32_t row : spatial::space_order(by_age, 8.0 * cell_m_)) {
    ordered.push_back(by_age[row]);
  }
  return ordered;
}

}  // namespace dynamic_icp::report
