// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::spatial {

/// The rows of finite points in an order in which successive ones are mostly near each other: along Morton's curve
/// through cubes of `cell_m`, within a cube by row. Any order is right for its users, this one is fast: points that
/// follow each other read the same memory. Cubes beyond 512 from the origin count as the last ones.
std::vector<std::uint32_t> space_order(std::span<const Eigen::Vector3d> points, double cell_m);

}  // namespace dynamic_icp::spatial
