// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <functional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/base/keep_memory.hpp"
#include "dynamic_icp/base/version.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"

namespace {

constexpr int kDataOrMachineFailed = 1;
constexpr int kWrongUsage = 2;

constexpr const char* kNotPrinted = "standard output: not all could be written";

/// The status, but what was printed must have arrived: a file that it was sent to may be full.
int with_output_written(int status) {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw dynamic_icp::DataError(kNotPrinted);
  }
  return status;
}

/// A first word that is no command deserves better than "a subcommand is required".
void refuse_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    return;
  }
  std::string known;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == argv[1]) {
      return;
    }
    known += " " + command->get_name();
  }
  throw dynamic_icp::UsageError(fmt::format("unknown command '{}'; known are:{}", argv[1], known));
}

int report(const char* message, int status) {
  fmt::print(stderr, "dynamic-icp: {}\n", message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace dynamic_icp;
  keep_freed_memory();
  apps::remember_command_line(argc, argv);
  CLI::App app{"Registration and odometry for FMCW LiDAR in scenes full of moving things", "dynamic-icp"};
  app.set_version_flag("--version", std::string(version()));
  app.require_subcommand(1);
  std::function<int()> selected;
  for (const auto add :
       {apps::add_run_command, apps::add_register_command, apps::add_evaluate_command, apps::add_benchmark_command,
        apps::add_simulate_command, apps::add_report_command, apps::add_plot_command, apps::add_convert_command,
        apps::add_info_command, apps::add_config_command}) {
    add(app, selected);
  }
  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return with_output_written(selected());
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "dynamic-icp: {}\nRun 'dynamic-icp --help' or 'dynamic-icp COMMAND --help'.\n", error.what());
    return kWrongUsage;
  } catch (const UsageError& error) {
    return report(error.what(), kWrongUsage);
  } catch (const std::bad_alloc&) {
    return report("the machine has no memory left", kDataOrMachineFailed);
  } catch (const std::exception& error) {
    // Long texts fail while they are printed, not at the end.
    return report(std::ferror(stdout) != 0 ? kNotPrinted : error.what(), kDataOrMachineFailed);
  }
}
