// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/keep_memory.hpp"
#include "apps/messages.hpp"
#include "apps/process.hpp"

namespace {

namespace apps = dynamic_icp::apps;
using dynamic_icp::DataError;
using dynamic_icp::UsageError;
using dynamic_icp::version;

constexpr int kDataOrMachineFailed = 1;
constexpr int kWrongUsage = 2;

constexpr const char* kNotPrinted = "standard output: not all could be written";

/// The status, but what was printed must have arrived: a file that it was sent to may be full.
int with_output_written(int status) {
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw DataError(kNotPrinted);
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
  throw UsageError(fmt::format("unknown command '{}'; known are:{}", argv[1], known));
}

/// An unknown option is said before a missing one: mistyped, it is both.
void refuse_unknown_option(const CLI::App& command) {
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      known.push_back("--" + name);
    }
  }
  for (const std::string& word : command.remaining()) {
    if (word.starts_with("--")) {
      throw UsageError(fmt::format("'{}' has no option '{}'; did you mean '{}'?", command.get_name(), word,
                                   dynamic_icp::nearest_key(word, known)));
    }
  }
}

int report(const std::string& message, int status) {
  apps::tell("dynamic-icp: {}\n", message);
  return status;
}

/// The system names what it lacks, but not what for.
std::string what_failed(const std::system_error& error) {
  const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
  return fmt::format("{}{}", no_thread ? "cannot start another thread (--threads N takes fewer): " : "", error.what());
}

/// Carries out what the command line says.
int run(int argc, char** argv) {
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
  refuse_unknown_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return with_output_written(app.exit(help_or_version));
  } catch (const CLI::ParseError&) {
    for (const CLI::App* command : app.get_subcommands()) {
      refuse_unknown_option(*command);
    }
    throw;
  }
  return with_output_written(selected());
}

}  // namespace

int main(int argc, char** argv) {
  apps::open_standard_streams();
  apps::clean_up_on_signals();
  dynamic_icp::keep_freed_memory();
  apps::remember_command_line(argc, argv);
  try {
    return run(argc, argv);
  } catch (const CLI::ParseError& error) {
    return report(fmt::format("{}\nRun 'dynamic-icp --help' or 'dynamic-icp COMMAND --help'.", error.what()),
                  kWrongUsage);
  } catch (const UsageError& error) {
    return report(error.what(), kWrongUsage);
  } catch (const dynamic_icp::formats::EarlierResult& error) {
    return report(fmt::format("{}; use --force to replace it", error.what()), kDataOrMachineFailed);
  } catch (const std::bad_alloc&) {
    return report("the machine has no memory left", kDataOrMachineFailed);
  } catch (const std::system_error& error) {
    return report(std::ferror(stdout) != 0 ? kNotPrinted : what_failed(error), kDataOrMachineFailed);
  } catch (const std::exception& error) {
    // Long texts fail while they are printed, not at the end.
    return report(std::ferror(stdout) != 0 ? kNotPrinted : error.what(), kDataOrMachineFailed);
  }
}
