// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// --format, --field, --lidar, --topic, --truth-topic, --period, --dtype and --time-scale, and those of
/// `add_correction_options`: what a user may say about a recording.
void add_input_options(CLI::App& command, datasets::InputSettings& settings);

/// --doppler-sign, --doppler-kind, --doppler-scale, --point-scale, --columns: how numbers of a scan are corrected.
void add_correction_options(CLI::App& command, datasets::InputSettings& settings);

/// The options that state a correction; "" where it states nothing.
std::string as_options(const datasets::Correction& correction);

/// The options that fix what is found; "" where none do.
std::string fixing_options(const diagnosis::Finding& finding);

}  // namespace dynamic_icp::apps
