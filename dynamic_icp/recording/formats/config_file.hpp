// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::formats {

/// Reads settings from a YAML file into the configuration behind `fields`. Keys may be nested maps or dotted
/// ("preprocess.voxel.voxel_size_m: 0.5"). Throws UsageError naming file, line and key for unknown keys and values out
/// of range, DataError for files that cannot be read or are no YAML.
void load_config_file(const std::filesystem::path& path, const ConfigFields& fields);

/// The settings as YAML that `load_config_file` reads back, with unit, range and meaning as comments.
std::string config_yaml(const ConfigFields& fields);

}  // namespace dynamic_icp::formats
