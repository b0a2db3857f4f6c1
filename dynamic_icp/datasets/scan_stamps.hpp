// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/base/stamp.hpp"

namespace dynamic_icp::datasets {

/// When the scans of these files begin, by the number in their names: its digits tell the unit (19: nanoseconds, 16:
/// micro-, 13: milliseconds, 10: seconds, all since 1970). Names whose numbers are shorter only count the scans, which
/// then are `period_s` apart from 0 on; this is added to the assumptions.
std::vector<Stamp> stamps_of(const std::vector<std::filesystem::path>& files, double period_s,
                             std::vector<std::string>& assumptions);

}  // namespace dynamic_icp::datasets
