// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/window/window_config.hpp"
#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/paper.hpp"

namespace dynamic_icp::figures {

/// What was learned of the error of the Doppler beyond its direction, with one standard deviation: of each line and
/// each face, where the sensor has several, and by range, for each sensor of a rig.
drawing::Svg field_parts_plot(const window::SensorCalibration& calibration, const drawing::Theme& theme,
                              Medium medium = Medium::kScreen);

}  // namespace dynamic_icp::figures
