// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/expectation.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {

/// Sets `is_moving` of the rows of a scan that is not deskewed that an expectation may take for its own: in its box,
/// without the lowest part but with its gate around, and with the radial velocity that it expects.
void flag_rows(const Scan& scan, std::span<const double> radial, const SensorMotion& sensor,
               std::span<const Expectation> expectations, const Workers& workers, std::vector<std::uint8_t>& is_moving);

}  // namespace dynamic_icp::tracking
