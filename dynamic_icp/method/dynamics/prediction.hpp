// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/dynamics/object_velocity.hpp"

namespace dynamic_icp::dynamics {

/// The source of the alignment, Eq. (11) of the paper: the static rows where they are, and the members of each accepted
/// object where they will be dt_s seconds later at constant velocity, p + v_k dt (Eq. 9). Moving points that belong to
/// no accepted object are left out: they are neither static nor predictable. Line of sight and Doppler stay as
/// measured. Rows are in scan order.
///
/// `is_dynamic` has one entry per row, nonzero for moving ones.
Scan predict(const Scan& scan, std::span<const std::uint8_t> is_dynamic, std::span<const ObjectEstimate> objects,
             double dt_s);

}  // namespace dynamic_icp::dynamics
