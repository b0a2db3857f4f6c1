// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/ground_view.hpp"
#include "dynamic_icp/tools/figures/scan_view.hpp"

namespace dynamic_icp::figures {

/// Arrows show the way covered in this time, in seconds.
constexpr double kArrowSeconds = 1.0;

/// Draws the sensor as a dot with an arrow for its velocity; the arrow is left out when the velocity is not known.
void draw_sensor(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground,
                 const Eigen::Vector3d& ego_velocity);

/// Draws the objects of a scan that lie in the region: box, arrow for the velocity, and for those with most points id
/// and speed in words; and the speed of the sensor in words. `compensated` is the Doppler without own motion, m/s.
void draw_object_marks(drawing::Svg& svg, const drawing::Theme& theme, const GroundView& ground, const ScanView& view,
                       const std::vector<double>& compensated);

}  // namespace dynamic_icp::figures
