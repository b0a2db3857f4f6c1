// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::runs {

/// What was learned of a sensor as the text of calibration.yaml.
std::string calibration_text(const window::SensorCalibration& calibration);

/// Reads such a file. Throws UsageError naming the file, the line and what was expected when something is missing or
/// out of range, DataError when it cannot be read or is no YAML.
window::SensorCalibration read_calibration(const std::filesystem::path& path);

/// That of a run, which stands in its folder; nothing where it learned nothing.
std::optional<window::SensorCalibration> read_calibration_of(const std::filesystem::path& run_folder);

}  // namespace dynamic_icp::runs
