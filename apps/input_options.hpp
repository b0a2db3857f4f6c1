// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// --format, --field, --lidar, --period and --time-scale, and those of `add_correction_options`: what a user may say
/// about a recording.
void add_input_options(CLI::App& command, datasets::InputSettings& settings);

/// --doppler-sign, --doppler-kind, --doppler-scale, --point-scale, --columns: how numbers of a scan are to be mended.
void add_correction_options(CLI::App& command, datasets::InputSettings& settings);

}  // namespace dynamic_icp::apps
