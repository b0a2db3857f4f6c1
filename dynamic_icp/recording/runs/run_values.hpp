// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace dynamic_icp::runs {

/// A value of summary.json or run.json: null, a switch, a number or a text.
using Value = std::variant<std::monostate, bool, double, std::string>;

/// Keys with their values in the order of the keys; nested objects have dotted keys.
using Settings = std::vector<std::pair<std::string, Value>>;

/// The text of the value of a key; empty when there is no such key or it is null.
std::string text_of(const Settings& settings, std::string_view key);

/// The number that is the value of a key; nothing when there is no such key or it is no number.
std::optional<double> number_of(const Settings& settings, std::string_view key);

/// What run.json says.
struct RunRecord {
  Settings about;          ///< all but what follows
  Settings configuration;  ///< "configuration"
  std::vector<std::string> assumptions;
  std::vector<std::string> warnings;
};

/// summary.json and run.json. Throw DataError naming the file when it is no complete JSON object.
Settings read_summary(const std::filesystem::path& path);
RunRecord read_run_json(const std::filesystem::path& path);

}  // namespace dynamic_icp::runs
