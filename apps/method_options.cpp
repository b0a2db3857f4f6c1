// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/method_options.hpp"

#include <algorithm>
#include <iterator>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"

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

namespace {

/// A key of the configuration that does what the other one would have done elsewhere, as far as names tell.
std::string nearest_effective(const std::string& key, const ConfigFields& effective) {
  const std::string last = key.substr(key.rfind('.') + 1);
  std::vector<std::string> keys;
  for (const ConfigField& field : effective) {
    if (field.key.ends_with("." + last)) {
      return field.key;
    }
    keys.push_back(field.key);
  }
  return std::string(nearest_key(key, keys));
}

std::vector<std::string> keys_of(const std::vector<std::string>& settings) {
  std::vector<std::string> keys;
  for (const std::string& setting : settings) {
    keys.push_back(setting.substr(0, setting.find('=')));
  }
  return keys;
}

/// The keys of --set, and those of the file that change something: it may list all, as `dynamic-icp config` prints
/// them.
std::vector<std::string> given_keys(const MethodOptions& options) {
  std::vector<std::string> keys = keys_of(options.settings);
  if (!options.config_file.empty()) {
    odometry::Config config = odometry::preset(options.preset);
    const ConfigFields fields = odometry::fields(config);
    std::vector<std::string> before;
    std::ranges::transform(fields, std::back_inserter(before), value_text);
    formats::load_config_file(options.config_file, fields);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (value_text(fields[i]) != before[i]) {
        keys.push_back(fields[i].key);
      }
    }
  }
  return keys;
}

}  // namespace

void refuse_ineffective_keys(const MethodOptions& options, const std::vector<std::string>& methods) {
  odometry::Config config = resolve_config(options);
  ConfigFields effective;
  for (const std::string& method : methods) {
    ConfigFields of_method = odometry::effective_fields(config, method);
    effective.insert(effective.end(), of_method.begin(), of_method.end());
  }
  for (const std::string& key : given_keys(options)) {
    if (std::any_of(effective.begin(), effective.end(), [&](const ConfigField& field) { return field.key == key; })) {
      continue;
    }
    const std::string nearest = nearest_effective(key, effective);
    throw UsageError(fmt::format("configuration key '{}' has no effect on {} with preset {}{}", key,
                                 fmt::join(methods, ", "), options.preset,
                                 nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
}

odometry::Config make_config(const MethodOptions& options) {
  odometry::Config config = resolve_config(options);
  refuse_ineffective_keys(options, {options.method});
  return config;
}

odometry::Config resolve_config(const MethodOptions& options) {
  odometry::check_method(options.method);
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
