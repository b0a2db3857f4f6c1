// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/target.hpp"

#include <utility>

namespace dynamic_icp::registration {

PreparedTarget::PreparedTarget(Scan points, const Workers& workers)
    : scan(std::move(points)), tree(scan.points(), workers) {}

PreparedTarget::PreparedTarget(Scan points, const preprocess::NormalsConfig& config, const Workers& workers)
    : PreparedTarget(std::move(points), workers) {
  normals = preprocess::estimate_normals(scan.points(), tree, config, workers);
}

std::optional<double> plane_distance(const Target& target, const Eigen::Vector3d& point, double max_distance_m) {
  const std::optional<spatial::Neighbour> nearest = target.tree.nearest(point, max_distance_m);
  if (!nearest || target.has_normal[nearest->index] == 0) {
    return std::nullopt;
  }
  return target.normals[nearest->index].dot(point - target.scan.points()[nearest->index]);
}

}  // namespace dynamic_icp::registration
