// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "dynamic_icp/tools/drawing/raster.hpp"
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

namespace dynamic_icp::simulation {

/// The scan as the sensor sees it: left to right and top to bottom over its field of view, each return in the colour
/// that `colour_of` gives for its row in the scan, `nothing` where there is none. At most `width` pixels wide.
drawing::Raster sensor_view(const FmcwLidarConfig& lidar, const SimulatedScan& scan, std::size_t width,
                            drawing::Rgb nothing, const std::function<drawing::Rgb(std::size_t)>& colour_of);

}  // namespace dynamic_icp::simulation
