// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/tools/figures/field_summary.hpp"

namespace dynamic_icp::figures {

/// The error of a sensor's Doppler over azimuth and elevation in lines of characters (UTF-8, no colours, at most 78
/// wide), as the sensor looks out, with its scale. A direction is unknown where the standard deviation of the error is
/// larger than the error is as a rule.
std::string field_text(const FieldSummary& learned);

}  // namespace dynamic_icp::figures
