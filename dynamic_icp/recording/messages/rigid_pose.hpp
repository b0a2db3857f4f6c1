// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Geometry>

namespace dynamic_icp::messages {

/// Whether its four numbers have a length of 1 within a tenth: what is farther off is no rotation written carelessly.
bool is_rotation(const Eigen::Quaterniond& quaternion);

/// The transform that a position (m) and a quaternion say. Throws DataError that begins with `origin` and names the
/// field where they say none.
Eigen::Isometry3d rigid_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
                             const std::string& origin, std::string_view field);

}  // namespace dynamic_icp::messages
