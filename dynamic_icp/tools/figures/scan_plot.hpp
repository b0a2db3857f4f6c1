// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/paper.hpp"
#include "dynamic_icp/tools/figures/scan_view.hpp"

namespace dynamic_icp::figures {

/// The scan from above, the way ahead to the right, in two panels with one colour scale: the Doppler as measured, and
/// the Doppler compensated for the ego motion, in which static things are grey and moving ones red or blue, with the
/// boxes, ids and velocities of the objects. Arrows are as long as the way covered in one second. The second panel is
/// left out when the ego velocity is not known. At most 13,000 points are drawn, which keeps the file under
/// 300 KB.
drawing::Svg scan_plot(const ScanView& view, const drawing::Theme& theme, Medium medium = Medium::kScreen);

}  // namespace dynamic_icp::figures
