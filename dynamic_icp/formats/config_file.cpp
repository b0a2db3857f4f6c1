// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/config_file.hpp"

#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

struct Reader {
  const std::filesystem::path& path;
  const ConfigFields& fields;
  std::set<std::string> seen;

  void read_map(const YAML::Node& map, const std::string& prefix) {
    for (const auto& entry : map) {
      const std::string key = prefix + entry.first.as<std::string>();
      if (entry.second.IsMap()) {
        read_map(entry.second, key + ".");
      } else {
        read_value(entry.first, entry.second, key);
      }
    }
  }

  void read_value(const YAML::Node& name, const YAML::Node& value, const std::string& key) {
    const std::string place = fmt::format("{}: line {}", path.string(), name.Mark().line + 1);
    if (!seen.insert(key).second) {
      throw UsageError(fmt::format("{}: configuration key '{}' is set twice", place, key));
    }
    try {
      set_field(fields, key, value.IsScalar() ? value.Scalar() : "");
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", place, error.what()));
    }
  }
};

}  // namespace

void load_config_file(const std::filesystem::path& path, const ConfigFields& fields) {
  const std::string text = read_whole_file(path);
  try {
    const YAML::Node root = YAML::Load(text);
    if (root.IsNull()) {
      return;
    }
    if (!root.IsMap()) {
      throw DataError(fmt::format("{}: expected a map of configuration keys", path.string()));
    }
    Reader{path, fields, {}}.read_map(root, "");
  } catch (const YAML::Exception& error) {
    throw DataError(fmt::format("{}: is no YAML: {}", path.string(), error.what()));
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
