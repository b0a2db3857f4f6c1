// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include <yaml-cpp/yaml.h>

#include "dynamic_icp/method/base/config_field.hpp"

// The side of yaml_map.hpp that sees the YAML library.
namespace dynamic_icp::formats {

/// Longer documents are refused.
constexpr std::size_t kMaxYamlBytes = std::size_t{8} << 20U;

/// So are those with more values, lists and maps: the parser takes half a kilobyte for each, and one byte of text can
/// be one. The calibration of a sensor with 128 lines has 30,000, that of a rig of 32 sensors 250,000.
constexpr std::size_t kMaxYamlNodes = 300'000;

/// So is a part that is longer and of which the parser can make nothing before it has read all of it: a value, a
/// comment, or a list in a list in a list, of which the parser keeps 240 bytes for each byte.
constexpr std::size_t kMaxYamlPart = std::size_t{256} << 10U;

/// "<origin>: line <line>".
std::string place(const std::filesystem::path& origin, int line);

int line_of(const YAML::Node& node);

/// What was found, in words: "'text'", "a list of 3", "a map" or "nothing".
std::string found(const YAML::Node& node);

/// The node of a text that holds one document; undefined where it holds nothing. Throws DataError where the text is
/// too long, has too many nodes or too long a part, is not UTF-8 or no YAML.
YAML::Node parse_document(std::string_view text, const std::filesystem::path& origin);

/// Sets fields from nested maps; every key may be set once, whether nested or dotted.
class SettingsReader {
 public:
  SettingsReader(const std::filesystem::path& origin, const ConfigFields& fields) : origin_(origin), fields_(fields) {}

  /// Sets the field `key`, or those below it where the value is a map. Throws UsageError for a key that is unknown,
  /// also that of an empty map, and where aliases unfold to more keys than any configuration has.
  void read(const YAML::Node& key_node, const YAML::Node& value, const std::string& key, int depth = 0);

 private:
  /// Whether there are fields below this key.
  [[nodiscard]] bool holds_fields(const std::string& key) const;

  const std::filesystem::path& origin_;
  const ConfigFields& fields_;
  std::set<std::string> seen_;
  std::size_t visited_ = 0;
};

}  // namespace dynamic_icp::formats
