// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/surface_residual.hpp"

#include <cmath>
#include <limits>

#include "dynamic_icp/method/preprocess/voxel_grid.hpp"

namespace dynamic_icp::report {
namespace {

constexpr double kVoxel_m = 0.2;  // the surface is flat within; ten times fewer normals to find where scans are dense
constexpr double kNear_m = 1.0;
constexpr std::size_t kBlock = 256;

}  // namespace

registration::PreparedTarget surface_of(std::span<const Eigen::Vector3d> points, const Workers& workers) {
  RawScan raw;
  raw.points.assign(points.begin(), points.end());
  raw.doppler.assign(points.size(), 0.0);
  return {preprocess::voxel_grid(Scan::from_raw(raw), {kVoxel_m}, workers), {}, workers};
}

std::vector<double> surface_residual(const registration::PreparedTarget& surface,
                                     std::span<const Eigen::Vector3d> points, const Eigen::Isometry3d& T_surface_point,
                                     const Workers& workers) {
  const registration::Target target = surface.target();
  std::vector<double> residual(points.size(), std::numeric_limits<double>::quiet_NaN());
  workers.for_each(points.size(), kBlock, [&](std::size_t i) {
    if (const auto distance_m = registration::plane_distance(target, T_surface_point * points[i], kNear_m)) {
      residual[i] = std::abs(*distance_m);
    }
  });
  return residual;
}

}  // namespace dynamic_icp::report
