// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <memory>
#include <set>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/recording/formats/config_file.hpp"

#include "apps/commands.hpp"
#include "apps/options.hpp"

namespace dynamic_icp::apps {
namespace {

struct ConfigOptions {
  std::string preset = "default";
  std::string method = "dynamic-icp";
  bool markdown = false;
};

/// The value of a key where the pipeline reads it.
std::string value_in(const odometry::Pipeline& pipeline, const std::string& key) {
  odometry::Config config = pipeline.config;
  for (const ConfigField& field : odometry::fields(config)) {
    if (field.key == key) {
      return value_text(field);
    }
  }
  return "";
}

/// docs/configuration.md.
std::string reference_page() {
  std::string page =
      "# Configuration\n\n"
      "Every key can be set with `--set key=value` or in a YAML file given with `--config`, nested or dotted. The "
      "table has the\nvalue in force for each pipeline: the presets `default` and `paper` of dynamic-icp, "
      "and the\n"
      "baselines (`--method`). A pipeline without a value does not read the key, and setting it is refused. This page "
      "is made by `dynamic-icp config --markdown`.\n\n| key |";
  std::string rule = "|---|";
  for (const odometry::Pipeline& pipeline : odometry::pipelines()) {
    page += fmt::format(" {} |", pipeline.preset.empty() ? pipeline.method : pipeline.preset);
    rule += "---|";
  }
  page += fmt::format(" range | meaning |\n{}---|---|\n", rule);
  std::set<std::string> described;
  for (const odometry::Pipeline& reader : odometry::pipelines()) {
    odometry::Config config = reader.config;
    for (const ConfigField& field : odometry::fields(config)) {
      if (!described.insert(field.key).second) {
        continue;
      }
      page += fmt::format("| `{}` |", field.key);
      for (const odometry::Pipeline& pipeline : odometry::pipelines()) {
        page += fmt::format(" {} |", value_in(pipeline, field.key));
      }
      page += fmt::format(" {} | {} |\n", range_text(field), field.description);
    }
  }
  return page;
}

}  // namespace

void add_config_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ConfigOptions>();
  CLI::App* command =
      app.add_subcommand("config", "Print the configuration as YAML, to be edited and given to --config");
  add_option(*command, "--preset", options->preset, "NAME",
             fmt::format("Configuration to print: {} (default default)", fmt::join(odometry::preset_names(), ", ")));
  add_option(*command, "--method", options->method, "NAME",
             fmt::format("Method whose keys are printed: {} (default dynamic-icp)",
                         fmt::join(odometry::method_names(), ", ")));
  command->add_flag("--markdown", options->markdown, "Print the reference page of all keys and methods instead");
  command->callback([options, &selected] {
    selected = [options] {
      odometry::Config config = odometry::configuration(options->method, options->preset);
      fmt::print("{}", options->markdown ? reference_page() : formats::config_yaml(odometry::fields(config)));
      return 0;
    };
  });
}

}  // namespace dynamic_icp::apps
