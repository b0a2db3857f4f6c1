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

/// A configuration and what was given for it in vain.
struct ResolvedConfig {
  odometry::Config config;
  std::vector<std::string> unread;  ///< keys of --set, and of the file where they change something, not among its own
};

/// The configuration: the preset, then the file, then --set in their order, then the ablation. Throws UsageError or
/// DataError.
ResolvedConfig resolve_config(const MethodOptions& options);

/// Throws UsageError for a key that none of the methods reads: who sets it expects an effect. `methods` are those of
/// the configurations.
void refuse_unread_keys(const MethodOptions& options, const std::vector<std::string>& methods,
                        const std::vector<ResolvedConfig>& resolved);

/// The configuration of one method, without such keys.
odometry::Config make_config(const MethodOptions& options);

}  // namespace dynamic_icp::apps
