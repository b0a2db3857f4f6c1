// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/spatial/cell_order.hpp"

namespace dynamic_icp::ego_motion {

/// The ground, or whatever else carries or bounds the scene, in sensor axes: points are at normal . x > offset, but for
/// those on it.
struct SupportPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;

  [[nodiscard]] double height(const Eigen::Vector3d& x) const { return normal.dot(x) - offset_m; }
};

/// Whatever moves is seldom wide and flat with nothing behind it; the ground is. The plane on which most of the points
/// are that leaves nearly all others on one side and is wide in both directions; nothing where none is. No mounting and
/// no direction of gravity is needed: a wall that bounds the scene stands as well as the ground.
std::optional<SupportPlane> find_support_plane(const std::vector<Eigen::Vector3d>& points);

/// The same of a scan, by one point of each cell near by (`order` sorted its points).
std::optional<SupportPlane> find_support_plane(const Scan& scan, const spatial::CellOrder& order);

/// Of the cells of a scan, which `order` sorted and counts: 1 where most points are on the plane.
std::vector<std::uint8_t> cells_on_support(const Scan& scan, spatial::CellOrder& order, const SupportPlane& plane);

}  // namespace dynamic_icp::ego_motion
