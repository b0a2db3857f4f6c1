// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/surface_residual.hpp"

#include <cmath>
#include <limits>

#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

namespace dynamic_icp::report {
namespace {

constexpr double kVoxel_m = 0.2;  // the surface is flat within; ten times fewer normals to find where scans are dense
constexpr double kNear_m = 1.0;
constexpr std::size_t kBlock = 256;

std::vector<Eigen::Vector3d> thinned(std::span<const Eigen::Vector3d> points) {
  spatial::VoxelHashMap voxels(kVoxel_m, 1);
  voxels.add(points);
  return voxels.points();
}

}  // namespace

Surface surface_of(std::span<const Eigen::Vector3d> points, const Workers& workers) {
  std::vector<Eigen::Vector3d> kept = thinned(points);
  spatial::KdTree tree(kept, workers);
  preprocess::Normals normals = preprocess::estimate_normals(kept, tree, {}, workers);
  return {std::move(kept), std::move(tree), std::move(normals)};
}

std::vector<double> surface_residual(const Surface& surface, std::span<const Eigen::Vector3d> points,
                                     const Eigen::Isometry3d& T_surface_point, const Workers& workers) {
  std::vector<double> residual(points.size(), std::numeric_limits<double>::quiet_NaN());
  workers.for_each(points.size(), kBlock, [&](std::size_t i) {
    const Eigen::Vector3d p = T_surface_point * points[i];
    const std::optional<spatial::Neighbour> nearest = surface.tree.nearest(p, kNear_m);
    if (nearest && surface.normals.has(nearest->index)) {
      residual[i] = std::abs(surface.normals.vectors[nearest->index].dot(p - surface.points[nearest->index]));
    }
  });
  return residual;
}

}  // namespace dynamic_icp::report
