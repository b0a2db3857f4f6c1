// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/config_file.hpp"

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/yaml_map.hpp"

namespace dynamic_icp::formats {

void load_config_file(const std::filesystem::path& path, const ConfigFields& fields) {
  YamlMap::load(path, YamlMap::Blank::kEmptyMap).settings(fields);
}

std::string config_yaml(const ConfigFields& fields) {
  std::string yaml;
  for (const ConfigField& field : fields) {
    yaml += fmt::format("# {} [{}]\n{}: {}\n\n", field.description, range_text(field), field.key, value_text(field));
  }
  return yaml;
}

}  // namespace dynamic_icp::formats
