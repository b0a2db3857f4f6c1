// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/diagnosis/rig_offsets.hpp"

// What mountings are mixed up with as a rule, and whether the Doppler would agree then.
namespace dynamic_icp::diagnosis {

/// What sensor `wrong` may be meant to have instead of its mounting, in words: all that make it agree with sensor
/// `right`.
std::vector<std::string> explanations(const std::vector<RigLook>& rig_looks, std::size_t right, std::size_t wrong,
                                      std::span<const Eigen::Isometry3d> mountings);

/// What the mountings of all sensors may be, in words, where one mistake makes all of them agree; else empty.
std::string common_explanation(const std::vector<RigLook>& rig_looks, std::span<const Eigen::Isometry3d> mountings);

}  // namespace dynamic_icp::diagnosis
