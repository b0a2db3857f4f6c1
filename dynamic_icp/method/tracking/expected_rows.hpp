// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/expectation.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {

/// Sets `is_moving` of the rows of a scan that is not deskewed that an expectation may take for its own: in its box,
/// without the lowest part but with its gate around, and with the radial velocity that it expects. `patches`: of the
/// scan.
void flag_rows(const Scan& scan, const ScanPatches& patches, std::span<const double> radial, const SensorMotion& sensor,
               std::span<const Expectation> expectations, const Workers& workers, std::vector<std::uint8_t>& is_moving);

/// The rows, ascending, of the points that are not among the moving ones in the box of an expectation, without the
/// lowest part of the box, where the ground may be.
void find_static_rows(const TrackingInput& input, const Expectation& expected, std::vector<std::uint32_t>& rows);

}  // namespace dynamic_icp::tracking
