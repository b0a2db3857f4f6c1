// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::simulation {

/// The Doppler of a scan of one sensor without the sensor's own motion: s + u . v with the velocity v of the sensor at
/// each point's own time, m/s; 0 for what stands. The scan has times.
std::vector<double> compensated_doppler(const RawScan& scan, const Simulation& simulation, std::size_t sensor);

}  // namespace dynamic_icp::simulation
