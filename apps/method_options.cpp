// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/method_options.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"

#include "apps/messages.hpp"
#include "apps/options.hpp"
#include "apps/settings.hpp"

namespace dynamic_icp::apps {

void add_configuration_options(CLI::App& command, std::string& preset, std::string& config_file,
                               std::vector<std::string>& settings, int& threads) {
  add_option(
      command, "--preset", preset, "NAME",
      fmt::format("Configuration to start from: {} (default {})", fmt::join(odometry::preset_names(), ", "), preset));
  add_option(command, "--config", config_file, "FILE",
             "YAML file with configuration keys ('dynamic-icp config' prints them all)");
  add_option(command, "--set", settings, "KEY=VALUE",
             "Configuration key, e.g. preprocess.voxel.voxel_size_m=0.5 (m); repeatable, wins over --config")
      ->allow_extra_args(false)  // what follows the value is another argument
      ->take_all();
  add_option(command, "--threads", threads, "N",
             "Number of threads (default 0: all processors); results do not depend on it")
      ->check(CLI::Range(0, 1024));
}

void add_method_options(CLI::App& command, MethodOptions& options) {
  add_option(command, "--method", options.method, "NAME",
             fmt::format("Method: {} (default dynamic-icp)", fmt::join(odometry::method_names(), ", ")));
  add_option(
      command, "--ablation", options.ablation, "NAME",
      fmt::format("Part of dynamic-icp to switch off: {} (default none)", fmt::join(odometry::ablation_names(), ", ")));
  add_configuration_options(command, options.preset, options.config_file, options.settings, options.threads);
}

namespace {

// Of earlier versions, where it chose between the two presets of dynamic-icp.
constexpr const char* kScanToScan = "odometry.scan_to_scan";

/// Reads the file, which may list all keys, as `dynamic-icp config` prints them. Returns the keys that it changes.
std::vector<std::string> load_file(const std::string& path, const ConfigFields& fields) {
  std::vector<std::string> before;
  std::ranges::transform(fields, std::back_inserter(before), value_text);
  formats::load_config_file(path, fields);
  std::vector<std::string> changed;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (value_text(fields[i]) != before[i]) {
      changed.push_back(fields[i].key);
    }
  }
  return changed;
}

bool has_key(std::span<const ConfigField> fields, const std::string& key) {
  return std::ranges::find(fields, key, &ConfigField::key) != fields.end();
}

/// Sets what is given and returns the keys of it that are not those of the configuration: other pipelines read them.
std::vector<std::string> read_settings(const MethodOptions& options, odometry::Config& config) {
  std::vector<odometry::Config> others = {odometry::configuration("dynamic-icp", options.preset)};
  std::ranges::transform(odometry::pipelines(), std::back_inserter(others), &odometry::Pipeline::config);
  ConfigFields all = odometry::fields(config);
  const std::size_t own = all.size();
  for (odometry::Config& other : others) {
    std::ranges::copy_if(odometry::fields(other), std::back_inserter(all),
                         [&](const ConfigField& field) { return !has_key(all, field.key); });
  }
  for (const auto& [former, now] : odometry::renamed_keys()) {
    if (const auto field = std::ranges::find(all, now, &ConfigField::key); field != all.end()) {
      ConfigField renamed = *field;
      renamed.key = former;
      all.push_back(std::move(renamed));
    }
  }
  bool scan_to_scan = options.preset == "paper";
  all.push_back({kScanToScan, &scan_to_scan, 0, 0, "", ""});

  std::vector<std::string> given;
  if (!options.config_file.empty()) {
    given = load_file(options.config_file, all);
  }
  apply_settings(all, options.settings);
  for (const std::string& setting : options.settings) {
    given.push_back(split_setting(setting).first);
  }
  for (std::string& key : given) {
    const auto renamed =
        std::ranges::find(odometry::renamed_keys(), key, [](const auto& names) { return names.first; });
    key = renamed == odometry::renamed_keys().end() ? key : std::string(renamed->second);
  }
  std::erase_if(given, [&](const std::string& key) { return has_key(std::span(all).first(own), key); });
  return given;
}

std::vector<std::string> keys_of(odometry::Config config) {
  std::vector<std::string> keys;
  std::ranges::transform(odometry::fields(config), std::back_inserter(keys), &ConfigField::key);
  return keys;
}

/// A key of the configurations that does what the other one would have done elsewhere, as far as names tell.
std::string nearest_read(const std::string& key, const std::vector<ResolvedConfig>& resolved) {
  std::vector<std::string> keys;
  for (const ResolvedConfig& one : resolved) {
    std::ranges::copy(keys_of(one.config), std::back_inserter(keys));
  }
  const std::string last = key.substr(key.rfind('.'));
  const auto same = std::ranges::find_if(keys, [&](const std::string& known) { return known.ends_with(last); });
  return same != keys.end() ? *same : std::string(nearest_key(key, keys));
}

/// "kiss-icp", "preset paper, gicp": the pipelines that read a key.
std::string readers(const std::string& key) {
  std::vector<std::string> names;
  for (const odometry::Pipeline& pipeline : odometry::pipelines()) {
    odometry::Config config = pipeline.config;
    if (has_key(odometry::fields(config), key)) {
      names.push_back(pipeline.preset.empty() ? std::string(pipeline.method)
                                              : fmt::format("preset {}", pipeline.preset));
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

ResolvedConfig resolve_config(const MethodOptions& options) {
  ResolvedConfig resolved{odometry::configuration(options.method, options.preset), {}};
  if (options.ablation != "none" && options.method != "dynamic-icp") {
    throw UsageError(fmt::format("--ablation {}: parts can be switched off in dynamic-icp only, not in {}",
                                 options.ablation, options.method));
  }
  for (int round = 0; round < 2; ++round) {  // what the first one switches may bring in keys for the second
    resolved.unread = read_settings(options, resolved.config);
    odometry::apply_ablation(resolved.config, options.ablation);
  }
  odometry::check(resolved.config);
  return resolved;
}

void note_renamed_keys(const MethodOptions& options) {
  for (const std::string& setting : options.settings) {
    const std::string key = split_setting(setting).first;
    for (const auto& [former, now] : odometry::renamed_keys()) {
      if (key == former) {
        tell("dynamic-icp: note: configuration key '{}' is now '{}'; the former name goes with the next release\n",
             former, now);
      }
    }
  }
}

void refuse_unread_keys(const MethodOptions& options, const std::vector<std::string>& methods,
                        const std::vector<ResolvedConfig>& resolved) {
  note_renamed_keys(options);
  for (const std::string& key : resolved.front().unread) {
    const bool is_read = !std::ranges::all_of(
        resolved, [&](const ResolvedConfig& one) { return std::ranges::find(one.unread, key) != one.unread.end(); });
    if (is_read) {
      continue;
    }
    if (key == kScanToScan) {
      throw UsageError(fmt::format(
          "configuration key '{}' chooses nothing any more: dynamic-icp goes from scan to scan with --preset paper",
          key));
    }
    const std::string nearest = nearest_read(key, resolved);
    throw UsageError(fmt::format("configuration key '{}' has no effect on {} with preset {}, only on {}{}", key,
                                 fmt::join(methods, ", "), options.preset, readers(key),
                                 nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
}

odometry::Config make_config(const MethodOptions& options) {
  const ResolvedConfig resolved = resolve_config(options);
  refuse_unread_keys(options, {options.method}, {resolved});
  return resolved.config;
}

}  // namespace dynamic_icp::apps
