// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/report/comparison_report.hpp"
#include "dynamic_icp/tools/report/run_report.hpp"
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

#include "apps/commands.hpp"
#include "apps/messages.hpp"
#include "apps/number_list.hpp"
#include "apps/options.hpp"
#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMb = 1e6;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string output;
  std::optional<double> budget_mb;
  std::string frames;
  int threads = 0;
};

report::ViewerBundle required_viewer() {
  const std::optional<report::ViewerBundle> viewer = report::viewer_bundle();
  if (!viewer) {
    throw DataError(
        "this program was built without the viewer that draws the page: run scripts/install_viewer.sh in the folder of "
        "the sources (it needs node and npm, and runs 'npm ci' in viewer), then configure and build again");
  }
  return *viewer;
}

constexpr double kSmallestBudget_mb = 0.1;
constexpr double kLargestBudget_mb = 2000.0;

report::ScanChoice scan_choice(const ReportOptions& options) {
  report::ScanChoice choice;
  if (options.budget_mb) {
    if (!(*options.budget_mb >= kSmallestBudget_mb && *options.budget_mb <= kLargestBudget_mb)) {
      throw UsageError(fmt::format("--budget-mb is {}, expected {} to {} MB", *options.budget_mb, kSmallestBudget_mb,
                                   kLargestBudget_mb));
    }
    choice.budget_bytes = static_cast<std::size_t>(*options.budget_mb * kBytesPerMb);
  }
  choice.choose_whole = options.frames.empty();
  choice.whole = number_list("--frames", options.frames);
  return choice;
}

bool is_comparison(const ReportOptions& options) { return options.folders.size() > 1; }

/// Whatever is meant by another name, a page must not take its place: a result of the run above all.
fs::path named_destination(const fs::path& html) {
  const std::string ending = html.extension().string();
  std::error_code unreadable;
  if (ending != ".html" && ending != ".htm" && !fs::is_other(html, unreadable)) {
    throw UsageError(fmt::format("--output is '{}', expected a file that ends in .html", html.string()));
  }
  return html;
}

fs::path destination(const ReportOptions& options) {
  if (!options.output.empty()) {
    return named_destination(options.output);
  }
  const fs::path first = options.folders.front();
  return is_comparison(options)
             ? fs::absolute(first / "").lexically_normal().parent_path().parent_path() / "comparison.html"
             : first / "report.html";
}

report::PageContent content_of(const ReportOptions& options) {
  const std::vector<fs::path> folders(options.folders.begin(), options.folders.end());
  const bool any_is_benchmark = std::any_of(folders.begin(), folders.end(), report::is_benchmark_folder);
  if (!is_comparison(options) && !any_is_benchmark) {
    return report::run_report(folders.front(), scan_choice(options), Workers(options.threads));
  }
  if (options.budget_mb || !options.frames.empty()) {
    throw UsageError("--budget-mb and --frames are for the report of one run: others show no scans");
  }
  if (!is_comparison(options)) {
    return report::benchmark_report(folders.front(), destination(options));
  }
  if (any_is_benchmark) {
    throw UsageError("a benchmark folder has a report of its own, it cannot be one of several");
  }
  return report::comparison_report(folders, destination(options));
}

int write_page(const ReportOptions& options) {
  const report::ViewerBundle viewer = required_viewer();
  const fs::path html = destination(options);
  if (terminal_width(stderr) > 0) {
    tell("writing {} ...\n", html.string());
  }
  formats::write_whole_file(html, report::html_page(content_of(options), viewer));
  fmt::print("{}\n", fs::absolute(html).lexically_normal().string());
  return 0;
}

}  // namespace

bool has_viewer() { return report::viewer_bundle().has_value(); }

void write_report(const fs::path& run_folder, const fs::path& html, int threads) {
  const report::ViewerBundle viewer = required_viewer();
  formats::write_whole_file(html, report::html_page(report::run_report(run_folder, {}, Workers(threads)), viewer));
}

void add_report_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Make one self-contained HTML page of a run, of several, or of a benchmark");
  command
      ->add_option("DIR", options->folders,
                   "Folder of a run; several are compared; or the one of a benchmark, with its tables and all its runs")
      ->required();
  add_option(*command, "-o,--output", options->output, "FILE",
             "File to write (default: DIR/report.html; of several runs comparison.html beside the first one)");
  add_option(*command, "--budget-mb", options->budget_mb, "MB",
             fmt::format("Size that scans and map may have in the page, 0.1 to 2000 MB (default {} MB); scans are "
                         "thinned to it",
                         static_cast<double>(report::ScanChoice().budget_bytes) / kBytesPerMb));
  add_option(*command, "--frames", options->frames, "LIST",
             "Scans to keep whole whatever the budget, as lines of frames.jsonl counted from 0: 10,20-25 (default: "
             "a few informative ones as the budget allows)");
  add_option(*command, "--threads", options->threads, "N", "Maximum number of threads, 0: all processors (default 0)")
      ->check(CLI::Range(0, 1024));
  command->callback([options, &selected] { selected = [options] { return write_page(*options); }; });
}

}  // namespace dynamic_icp::apps
