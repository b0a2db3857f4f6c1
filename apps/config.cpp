// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/odometry/config.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/formats/config_file.hpp"

#include "apps/commands.hpp"

namespace dynamic_icp::apps {
namespace {

struct ConfigOptions {
  std::string preset = "default";
  bool markdown = false;
};

/// docs/configuration.md.
std::string reference_page(const ConfigFields& fields) {
  std::string page =
      "# Configuration\n\n"
      "Every key can be set with `--set key=value` or in a YAML file given with `--config`, nested or dotted. This "
      "page "
      "is\nmade by `dynamic-icp config --markdown`; the defaults are those of preset `paper`.\n\n"
      "| key | default | range | meaning |\n|---|---|---|---|\n";
  for (const ConfigField& field : fields) {
    page +=
        fmt::format("| `{}` | {} | {} | {} |\n", field.key, value_text(field), range_text(field), field.description);
  }
  return page;
}

}  // namespace

void add_config_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ConfigOptions>();
  CLI::App* command =
      app.add_subcommand("config", "Print the configuration as YAML, to be edited and given to --config");
  command->add_option("--preset", options->preset, "Configuration to print: paper, default (default default)")
      ->type_name("NAME");
  command->add_flag("--markdown", options->markdown, "Print the reference page of all keys instead");
  command->callback([options, &selected] {
    selected = [options] {
      odometry::Config config = odometry::preset(options->markdown ? "paper" : options->preset);
      const ConfigFields fields = odometry::fields(config);
      fmt::print("{}", options->markdown ? reference_page(fields) : formats::config_yaml(fields));
      return 0;
    };
  });
}

}  // namespace dynamic_icp::apps
