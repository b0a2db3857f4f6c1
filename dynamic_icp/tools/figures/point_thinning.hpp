// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::figures {

/// At most `count` rows of finite points, spread evenly over space: one for each occupied cube, of the finest cubes of
/// which there are not too many, and further ones from the next finer cubes, so that exactly `count` are kept where
/// there are more. Near, where points are dense, most are left out; far ones stay. Ordered along Morton's curve:
/// successive rows are mostly near each other. The same points give the same rows.
std::vector<std::uint32_t> spread_rows(std::span<const Eigen::Vector3d> points, std::size_t count);

}  // namespace dynamic_icp::figures
