// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>

namespace CLI {
class App;
}

// One function a command, each in the file of its name. It adds the sub-command with its options to `app`; when the
// user chose it, `selected` is set to what carries it out and gives the exit status.
namespace dynamic_icp::apps {

void add_run_command(CLI::App& app, std::function<int()>& selected);
void add_register_command(CLI::App& app, std::function<int()>& selected);
void add_evaluate_command(CLI::App& app, std::function<int()>& selected);
void add_benchmark_command(CLI::App& app, std::function<int()>& selected);
void add_simulate_command(CLI::App& app, std::function<int()>& selected);
void add_convert_command(CLI::App& app, std::function<int()>& selected);
void add_info_command(CLI::App& app, std::function<int()>& selected);
void add_plot_command(CLI::App& app, std::function<int()>& selected);
void add_report_command(CLI::App& app, std::function<int()>& selected);
void add_config_command(CLI::App& app, std::function<int()>& selected);
void add_manual_command(CLI::App& app, std::function<int()>& selected);
void add_completion_command(CLI::App& app, std::function<int()>& selected);

/// Whether this program was built with what draws the HTML pages.
bool has_viewer();

/// Makes the HTML page of a run folder as `report` does without options: for `run --report`. Throws DataError when the
/// program was built without the viewer.
void write_report(const std::filesystem::path& run_folder, const std::filesystem::path& html, int threads);

}  // namespace dynamic_icp::apps
