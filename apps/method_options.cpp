// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/method_options.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/config_file.hpp"
#include "dynamic_icp/odometry/odometry.hpp"

#include "apps/settings.hpp"

namespace dynamic_icp::apps {

void add_configuration_options(CLI::App& command, std::string& preset, std::string& config_file,
                               std::vector<std::string>& settings, int& threads) {
  command
      .add_option("--preset", preset,
                  fmt::format("Configuration to start from: {} (default {})", fmt::join(odometry::preset_names(), ", "),
                              preset))
      ->type_name("NAME");
  command
      .add_option("--config", config_file, "YAML file with configuration keys ('dynamic-icp config' prints them all)")
      ->type_name("FILE");
  command
      .add_option("--set", settings,
                  "Configuration key, e.g. preprocess.voxel.voxel_size_m=0.5 (m); repeatable, wins over --config")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)  // what follows the value is another argument
      ->take_all();
  command
      .add_option("--threads", threads, "Number of threads (default 0: all processors); results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 1024));
}

void add_method_options(CLI::App& command, MethodOptions& options) {
  command
      .add_option("--method", options.method,
                  fmt::format("Method: {} (default dynamic-icp)", fmt::join(odometry::method_names(), ", ")))
      ->type_name("NAME");
  command
      .add_option("--ablation", options.ablation,
                  fmt::format("Part of dynamic-icp to switch off: {} (default none)",
                              fmt::join(odometry::ablation_names(), ", ")))
      ->type_name("NAME");
  add_configuration_options(command, options.preset, options.config_file, options.settings, options.threads);
}

odometry::Config make_config(const MethodOptions& options) {
  const auto methods = odometry::method_names();
  if (std::find(methods.begin(), methods.end(), options.method) == methods.end()) {
    throw UsageError(fmt::format("unknown method '{}'; known are: {}", options.method, fmt::join(methods, ", ")));
  }
  if (options.ablation != "none" && options.method != "dynamic-icp") {
    throw UsageError(fmt::format("--ablation {}: parts can be switched off in dynamic-icp only, not in {}",
                                 options.ablation, options.method));
  }
  odometry::Config config = odometry::preset(options.preset);
  const ConfigFields fields = odometry::fields(config);
  if (!options.config_file.empty()) {
    formats::load_config_file(options.config_file, fields);
  }
  apply_settings(fields, options.settings);
  odometry::apply_ablation(config, options.ablation);
  odometry::check(config);
  return config;
}

}  // namespace dynamic_icp::apps
