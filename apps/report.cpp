// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/figures/report_page.hpp"
#include "dynamic_icp/figures/run_context.hpp"
#include "dynamic_icp/figures/run_folder.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

#include "apps/commands.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::string run_folder;
  std::string output;
};

int report(const ReportOptions& options) {
  const fs::path html =
      options.output.empty() ? fs::path(options.run_folder) / "report.html" : fs::path(options.output);
  write_report(options.run_folder, html);
  fmt::print("{}\n", fs::absolute(html).lexically_normal().string());
  return 0;
}

}  // namespace

void write_report(const fs::path& run_folder, const fs::path& html) {
  const figures::RunFiles run = figures::read_run(run_folder);
  formats::write_whole_file(html, figures::report_page(run, figures::read_context(run)));
}

void add_report_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Make one self-contained HTML page of a run");
  command->add_option("DIR", options->run_folder, "Folder of a run")->required();
  command->add_option("--output", options->output, "File to write (default: DIR/report.html)")->type_name("FILE");
  command->callback([options, &selected] { selected = [options] { return report(*options); }; });
}

}  // namespace dynamic_icp::apps
