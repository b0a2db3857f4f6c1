// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::simulation {

/// A picture (SVG) of a drive at one of its scans: the scene from above with the way driven, the moving bodies and the
/// fields of view; below it the scan as the first sensor sees it, coloured by range, Doppler and body.
std::string draw_overview(const Simulation& simulation, const SimulatedFrame& frame, drawing::Ground ground,
                          const Workers& workers);

}  // namespace dynamic_icp::simulation
