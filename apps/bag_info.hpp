// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"

namespace dynamic_icp::apps {

/// What the bag holds that an input is or has in it; nothing where it is another recording. Throws as opening does.
std::optional<datasets::BagSummary> bag_of(const std::string& input, const datasets::InputSettings& settings);

/// Whether it has clouds of points, which may be scans.
bool has_clouds(const datasets::BagSummary& bag);

/// Prints a line for each topic, and what was odd.
void print_topics(const datasets::BagSummary& bag);

/// The topics: name, type, encoding, messages, rate_hz, and the fields of clouds.
nlohmann::ordered_json topics_json(const datasets::BagSummary& bag);

}  // namespace dynamic_icp::apps
