// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::registration {

/// What the source is aligned to: a scan with the search tree over its points and the normals where there are any.
/// It only refers to its parts; they must outlive it.
struct Target {
  const Scan& scan;
  const spatial::KdTree& tree;
  std::span<const Eigen::Vector3d> normals;
  std::span<const std::uint8_t> has_normal;  ///< 1 where the normal may be used
};

/// A scan with its search tree and normals.
struct PreparedTarget {
  /// Without normals: for point-to-point terms.
  PreparedTarget(Scan points, const Workers& workers);
  PreparedTarget(Scan points, const preprocess::NormalsConfig& config, const Workers& workers);

  /// Valid as long as this is neither moved nor destroyed.
  [[nodiscard]] Target target() const { return {scan, tree, normals.vectors, normals.valid}; }

  Scan scan;
  spatial::KdTree tree;
  preprocess::Normals normals;
};

/// Signed distance (m) of a point from the plane through the nearest target point. Nothing where none lies within
/// `max_distance_m` or the nearest one has no normal.
std::optional<double> plane_distance(const Target& target, const Eigen::Vector3d& point, double max_distance_m);

}  // namespace dynamic_icp::registration
