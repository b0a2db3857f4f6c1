// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/config.hpp"

namespace CLI {
class App;
}

namespace dynamic_icp::apps {

/// The options that say what the method does, shared by the commands that run it.
struct MethodOptions {
  std::string method = "dynamic-icp";
  std::string preset = "default";
  std::string ablation = "none";
  std::string config_file;
  std::vector<std::string> settings;
  int threads = 0;
};

/// --preset, --config, --set, --threads, with the values as they are for defaults.
void add_configuration_options(CLI::App& command, std::string& preset, std::string& config_file,
                               std::vector<std::string>& settings, int& threads);

/// Those, --method and --ablation.
void add_method_options(CLI::App& command, MethodOptions& options);

/// The configuration: the preset, then the file, then --set in their order, then the ablation. Throws UsageError or
/// DataError.
odometry::Config resolve_config(const MethodOptions& options);

/// Throws UsageError for a key of --set or of the file that none of the methods reads: who sets it expects an effect.
void refuse_ineffective_keys(const MethodOptions& options, const std::vector<std::string>& methods);

/// Both.
odometry::Config make_config(const MethodOptions& options);

}  // namespace dynamic_icp::apps
