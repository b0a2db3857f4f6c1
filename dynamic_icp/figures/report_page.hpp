// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "dynamic_icp/figures/run_context.hpp"
#include "dynamic_icp/figures/run_figures.hpp"
#include "dynamic_icp/figures/run_folder.hpp"

namespace dynamic_icp::figures {

/// A run as one HTML page that needs nothing else: no network, no script, no font. It follows the reader's preference
/// for dark or light and fits from a phone to a wide screen. All that comes from the run is escaped: it is shown as
/// text whatever is in it.
std::string report_page(const RunFiles& run, const RunContext& context);

}  // namespace dynamic_icp::figures
