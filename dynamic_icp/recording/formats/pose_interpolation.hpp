// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::formats {

/// The pose at a time, straight and evenly turned from one pose to a later one; beyond them it continues alike.
Eigen::Isometry3d interpolate(const StampedPose& before, const StampedPose& after, Stamp stamp);

/// The pose at a time. Nothing where the trajectory has none before and after it, at most `max_gap_s` apart; at its
/// very end the last pose continues as the last two moved, for as long as these are apart.
std::optional<Eigen::Isometry3d> pose_at(const Trajectory& trajectory, Stamp stamp, double max_gap_s);

}  // namespace dynamic_icp::formats
