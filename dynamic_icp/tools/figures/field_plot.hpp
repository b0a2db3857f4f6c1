// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/window/window_config.hpp"
#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/paper.hpp"

namespace dynamic_icp::figures {

/// What was learned of a sensor's Doppler: its error over azimuth and elevation, as the sensor looks out, and below it
/// the standard deviation of that; the sensors of a rig below each other. Throws UsageError when the parts of the
/// calibration do not fit each other.
drawing::Svg field_plot(const window::SensorCalibration& calibration, const drawing::Theme& theme,
                        Medium medium = Medium::kScreen);

}  // namespace dynamic_icp::figures
