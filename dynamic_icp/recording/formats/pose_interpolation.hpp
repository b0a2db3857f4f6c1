// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::formats {

/// The pose at a time, straight and evenly turned from one pose to a later one; beyond them it continues alike.
Eigen::Isometry3d interpolate(const StampedPose& before, const StampedPose& after, Stamp stamp);

}  // namespace dynamic_icp::formats
