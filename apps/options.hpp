// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace dynamic_icp::apps {

/// An option of a command; `type` names its value in the help.
template <class Value>
CLI::Option* add_option(CLI::App& command, const char* name, Value& value, const char* type, const std::string& help) {
  return command.add_option(name, value, help)->type_name(type);
}

/// Whether an argument that may also be something else names a YAML file.
inline bool is_yaml_name(const std::string& name) { return name.ends_with(".yaml") || name.ends_with(".yml"); }

}  // namespace dynamic_icp::apps
