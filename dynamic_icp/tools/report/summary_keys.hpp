// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::report {

/// The value of a key of summary.json as a reader wants it: rounded, with its unit, shares in percent; "-" where it is
/// null or not there.
std::string value_with_unit(const runs::Settings& summary, std::string_view key);

/// What a key of summary.json says, in a few words; empty for keys that are not known.
std::string meaning_of(std::string_view key);

}  // namespace dynamic_icp::report
