// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace dynamic_icp::apps {

/// Whether an input is no recording, but a run or a file of what one learned: a folder of a run, or a YAML file.
bool names_calibration(const std::filesystem::path& input);

/// What was learned of a sensor, for people. Throws as `runs::read_calibration`, and DataError where a run learned
/// nothing.
std::string calibration_info(const std::filesystem::path& input);

/// The same as JSON.
std::string calibration_json(const std::filesystem::path& input);

}  // namespace dynamic_icp::apps
