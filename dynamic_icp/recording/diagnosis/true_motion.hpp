// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::diagnosis {

/// The pose at a time, straight and evenly turned between the poses before and after it. Nothing where the trajectory
/// has none within half a second before and after; at its very end the last pose goes on as the last two moved.
std::optional<Eigen::Isometry3d> pose_at(const formats::Trajectory& truth, Stamp stamp);

}  // namespace dynamic_icp::diagnosis
