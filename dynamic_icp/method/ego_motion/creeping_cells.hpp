// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

/// Which cells creep: their mean Doppler differs from that of the static scene by more than `sigmas` standard
/// deviations, though each point might be static, or by so much that moving is likelier: where most of what is not on
/// the ground moves, that is less. How far the static scene itself is off, by an error of the sensor, is
/// seen in the cells on the ground where `rows.on_support` tells them, and else in the farthest cell of each direction
/// sector, which is static far more often than not. Where many cells creep, those next to them that are off to the same
/// side do as well. `noise_mps` is the standard deviation of single points; those that are off by `moving_mps` or more
/// move or are false, and tell nothing of the others in their cell.
std::vector<std::uint8_t> creeping_cells(const DopplerRows& rows, const EgoVelocity& ego, double noise_mps,
                                         double moving_mps, double sigmas);

}  // namespace dynamic_icp::ego_motion
