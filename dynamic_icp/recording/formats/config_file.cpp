// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/config_file.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/formats/yaml_map.hpp"

namespace dynamic_icp::formats {

namespace {

/// JSON is YAML, too, so that a file of keys in it is read; but most JSON files are something else.
bool is_json_text(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{';
}

}  // namespace

void load_config_file(const std::filesystem::path& path, const ConfigFields& fields) {
  try {
    YamlMap::load(path, YamlMap::Blank::kEmptyMap).settings(fields);
  } catch (const UsageError& error) {
    if (!is_json_text(path)) {
      throw;
    }
    throw UsageError(
        fmt::format("{}: is a JSON file and no configuration; expected YAML with lines 'key: value'. In detail: {}",
                    path.string(), error.what()));
  }
}

std::string config_yaml(const ConfigFields& fields) {
  std::string yaml;
  for (const ConfigField& field : fields) {
    yaml += fmt::format("# {} [{}]\n{}: {}\n\n", field.description, range_text(field), field.key, value_text(field));
  }
  return yaml;
}

}  // namespace dynamic_icp::formats
