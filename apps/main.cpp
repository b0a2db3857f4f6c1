// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"

#include "apps/build_info.hpp"
#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/exit_status.hpp"
#include "apps/help_format.hpp"
#include "apps/input_options.hpp"
#include "apps/keep_memory.hpp"
#include "apps/messages.hpp"
#include "apps/process.hpp"
#include "apps/terminal.hpp"
#include "apps/wrong_words.hpp"

namespace {

namespace apps = dynamic_icp::apps;
using dynamic_icp::DataError;
using dynamic_icp::UsageError;

using apps::kDataOrMachineFailed;
using apps::kWrongUsage;

constexpr const char* kNotPrinted = "standard output: not all could be written";

/// The status, but what was printed must have arrived: a file that it was sent to may be full.
int with_output_written(int status) {
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw DataError(kNotPrinted);
  }
  return status;
}

int report(std::string_view message, int status) {
  apps::tell("dynamic-icp: {}\n", message);
  return status;
}

/// The system names what it lacks, but not what for.
std::string what_failed(const std::system_error& error) {
  const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
  return fmt::format("{}{}", no_thread ? "cannot start another thread (--threads N takes fewer): " : "", error.what());
}

/// The command line without the program, `help` and `version` as the options that they mean.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.resize(std::min<std::size_t>(words.size(), 1));
    words.emplace_back("--help");
  } else if (!words.empty() && words.front() == "version") {
    words.front() = "--version";
  }
  return words;
}

/// Carries out what the command line says.
int run(int argc, char** argv) {
  const std::vector<std::string> words = words_of(argc, argv);
  CLI::App app{"Registration and odometry for FMCW LiDAR in highly dynamic scenes", "dynamic-icp"};
  app.formatter(std::make_shared<apps::HelpFormat>(apps::terminal_width(words.empty() ? stderr : stdout)));
  app.set_version_flag("-v,--version", apps::build_info());
  app.footer("'dynamic-icp COMMAND --help' and 'dynamic-icp help COMMAND' explain a command and its options.");
  app.require_subcommand(1);
  std::function<int()> selected;
  for (const auto add :
       {apps::add_run_command, apps::add_register_command, apps::add_evaluate_command, apps::add_benchmark_command,
        apps::add_simulate_command, apps::add_report_command, apps::add_plot_command, apps::add_convert_command,
        apps::add_info_command, apps::add_config_command, apps::add_manual_command, apps::add_completion_command}) {
    add(app, selected);
  }
  if (words.empty()) {
    std::fputs(app.help().c_str(), stderr);
    return kWrongUsage;
  }
  apps::refuse_unknown_command(app, words);
  apps::refuse_single_dashes(app, words);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as it takes them: the last word first
  } catch (const CLI::Success& help_or_version) {
    return with_output_written(app.exit(help_or_version));
  } catch (const CLI::ParseError& error) {
    throw UsageError(apps::explanation(app, error));
  }
  return with_output_written(selected());
}

/// The same, with what went wrong as a message and a status.
int run_or_report(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    return report(error.what(), kWrongUsage);
  } catch (const dynamic_icp::formats::EarlierResult& error) {
    return report(fmt::format("{}; use --force to replace it", error.what()), kDataOrMachineFailed);
  } catch (const dynamic_icp::datasets::UnclearInput& error) {
    return report(apps::with_options(error), kDataOrMachineFailed);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& error) {
    return report(std::ferror(stdout) != 0 ? kNotPrinted : what_failed(error), kDataOrMachineFailed);
  } catch (const std::exception& error) {
    // Long texts fail while they are printed, not at the end.
    return report(std::ferror(stdout) != 0 ? kNotPrinted : error.what(), kDataOrMachineFailed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  apps::open_standard_streams();
  apps::clean_up_on_signals();
  apps::clean_up_without_memory();
  apps::reserve_stack();
  dynamic_icp::keep_freed_memory();
  try {
    apps::remember_command_line(argc, argv);
    return run_or_report(argc, argv);
  } catch (const std::bad_alloc&) {  // of the messages above, too
    return report("the machine has no memory left", kDataOrMachineFailed);
  }
}
