// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"

#include "apps/commands.hpp"

namespace dynamic_icp::apps {
namespace {

struct ConfigOptions {
  std::string preset = "default";
  std::string method = "dynamic-icp";
  bool markdown = false;
};

/// A pipeline in docs/configuration.md.
struct Pipeline {
  const char* method;
  const char* preset;
  const char* column;
};
constexpr Pipeline kPipelines[] = {
    {"dynamic-icp", "default", "default"},           {"dynamic-icp", "paper", "paper"},
    {"doppler-icp", "default", "doppler-icp"},       {"point-to-plane", "default", "point-to-plane, gicp"},
    {"point-to-point", "default", "point-to-point"}, {"kiss-icp", "default", "kiss-icp"}};

/// The value of a key where the pipeline reads it.
std::string value_in(const Pipeline& pipeline, const std::string& key) {
  odometry::Config config = odometry::preset(pipeline.preset);
  for (const ConfigField& field : odometry::effective_fields(config, pipeline.method)) {
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
      "table "
      "has the\nvalue in force for each pipeline: the presets `default` and `paper` of dynamic-icp, and the baselines "
      "(`--method`). A pipeline\nwithout a value does not read the key, and setting it is refused. This page is made "
      "by "
      "`dynamic-icp config --markdown`.\n\n| key |";
  for (const Pipeline& pipeline : kPipelines) {
    page += fmt::format(" {} |", pipeline.column);
  }
  page += " range | meaning |\n|---|---|---|---|---|---|---|---|---|\n";
  odometry::Config config;
  for (const ConfigField& field : odometry::fields(config)) {
    page += fmt::format("| `{}` |", field.key);
    for (const Pipeline& pipeline : kPipelines) {
      page += fmt::format(" {} |", value_in(pipeline, field.key));
    }
    page += fmt::format(" {} | {} |\n", range_text(field), field.description);
  }
  return page;
}

}  // namespace

void add_config_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ConfigOptions>();
  CLI::App* command =
      app.add_subcommand("config", "Print the configuration as YAML, to be edited and given to --config");
  command
      ->add_option(
          "--preset", options->preset,
          fmt::format("Configuration to print: {} (default default)", fmt::join(odometry::preset_names(), ", ")))
      ->type_name("NAME");
  command
      ->add_option("--method", options->method,
                   fmt::format("Method whose keys are printed: {} (default dynamic-icp)",
                               fmt::join(odometry::method_names(), ", ")))
      ->type_name("NAME");
  command->add_flag("--markdown", options->markdown, "Print the reference page of all keys and methods instead");
  command->callback([options, &selected] {
    selected = [options] {
      odometry::Config config = odometry::preset(options->preset);
      odometry::check_method(options->method);
      const ConfigFields fields = odometry::effective_fields(config, options->method);
      fmt::print("{}", options->markdown ? reference_page() : formats::config_yaml(fields));
      return 0;
    };
  });
}

}  // namespace dynamic_icp::apps
