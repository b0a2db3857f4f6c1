// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// What to say of a recording of a single scan.
inline constexpr const char* kOneScan = "one scan: there is no motion to find; `register` aligns two";

/// --format, --field, --lidar, --topic, --truth-topic, --period, --dtype and --time-scale, and those of
/// `add_correction_options`: what a user may say about a recording.
void add_input_options(CLI::App& command, datasets::InputSettings& settings);

/// --doppler-sign, --doppler-kind, --doppler-scale, --point-scale, --columns: how numbers of a scan are corrected.
void add_correction_options(CLI::App& command, datasets::InputSettings& settings);

/// Settings of an input (input_settings.hpp) as the options that state them, as a shell takes them.
std::string as_options(const std::vector<std::pair<std::string, std::string>>& settings);

/// What stands in the way of reading an input, with the options that help, if there are any.
std::string with_options(const std::string& what, const datasets::UnclearInput::Settings& proposal);

/// The same with all that may be meant, the likeliest first.
std::string with_options(const datasets::UnclearInput& error);

/// The options that fix what is found of an input that was opened with these settings, to be stated instead of or
/// beside those; "" where none do.
std::string fixing_options(const diagnosis::Finding& finding, const datasets::InputSettings& settings);

}  // namespace dynamic_icp::apps
