// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"
#include "dynamic_icp/tools/benchmark/caption.hpp"
#include "dynamic_icp/tools/benchmark/cell_plan.hpp"
#include "dynamic_icp/tools/benchmark/cell_queue.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"
#include "dynamic_icp/tools/benchmark/manifest.hpp"
#include "dynamic_icp/tools/benchmark/sequences.hpp"
#include "dynamic_icp/tools/benchmark/tables.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"

#include "apps/candidates.hpp"
#include "apps/cell_progress.hpp"
#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/messages.hpp"
#include "apps/method_options.hpp"
#include "apps/options.hpp"
#include "apps/scan_selection.hpp"
#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResultsName = "results.json";

struct BenchmarkOptions {
  std::vector<std::string> inputs;
  std::string manifest;
  std::string root;
  std::string output;
  std::string tables;
  std::string methods = "all";
  std::optional<std::string> ablations;  ///< empty: all of all methods, none of methods that are named
  int jobs = 1;
  bool force = false;
  bool quiet = false;
  benchmark::RunSettings run;
};

benchmark::Program this_program() {
  // The running program itself, even when its file is replaced while the benchmark continues.
  const fs::path path = "/proc/self/exe";
  return {path, std::string(version()), benchmark::file_checksum(path), benchmark::describe_processor()};
}

benchmark::BenchmarkInfo describe(const BenchmarkOptions& options, const std::vector<benchmark::Sequence>& sequences) {
  benchmark::BenchmarkInfo info;
  info.version = std::string(version());
  info.command = command_line();
  info.machine = benchmark::describe_machine();
  info.threads = options.run.threads;
  info.jobs = options.jobs;
  info.preset = options.run.preset;
  info.settings = options.run.settings;
  if (!options.run.config_file.empty()) {
    info.settings.insert(info.settings.begin(), "the settings of " + options.run.config_file);
  }
  for (const benchmark::Sequence& sequence : sequences) {
    info.sequences.emplace_back(sequence.label, sequence.path.string());
  }
  return info;
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw DataError(fmt::format("standard output: cannot write: {}", std::strerror(errno)));
  }
}

/// The forms of a table, by the endings of their files.
const std::pair<const char*, std::string (*)(const benchmark::Table&)> kTableForms[] = {
    {".md", benchmark::markdown}, {".csv", benchmark::csv}, {".tex", benchmark::latex}};

/// A folder without tables of earlier results, which the new ones may not replace. Other files are left alone.
void make_tables_folder(const fs::path& folder) {
  formats::make_folder(folder);
  for (const std::string& name : benchmark::table_names()) {
    for (const auto& [ending, write] : kTableForms) {
      std::error_code fault;
      fs::remove(folder / (name + ending), fault);
    }
  }
}

/// What is printed: aligned, what tables have in common once, at the end.
std::string plain_text(const std::vector<benchmark::Table>& tables, const benchmark::BenchmarkResults& results) {
  const std::size_t width = terminal_width(stdout);
  std::string text;
  for (const benchmark::Table& table : tables) {
    text += benchmark::plain(table) + "\n" + wrapped(benchmark::own_caption(table, results), width, 0) + "\n\n";
  }
  return text + wrapped(benchmark::setup_text(results), width, 0) + "\n";
}

/// Makes tables/ and tables.md from results.json and prints the tables.
void write_tables(const fs::path& folder) {
  const fs::path source = folder / kResultsName;
  const benchmark::BenchmarkResults results = benchmark::results_from_json(formats::read_text_file(source), source);
  make_tables_folder(folder / "tables");
  std::string all;
  const std::vector<benchmark::Table> tables = benchmark::all_tables(results);
  for (const benchmark::Table& table : tables) {
    for (const auto& [ending, write] : kTableForms) {
      formats::write_whole_file(folder / "tables" / (table.name + ending), write(table));
    }
    all += (all.empty() ? "" : "\n") + benchmark::markdown(table);
  }
  formats::write_whole_file(folder / "tables.md", all);
  print(plain_text(tables, results));
}

std::string name_of(const benchmark::CellKey& key) {
  return key.sequence + " " + key.method + (key.ablation == "none" ? "" : " " + key.ablation);
}

/// Runs the cells and saves results.json after each of them; how many failed.
std::size_t run_plans(const BenchmarkOptions& options, const benchmark::BenchmarkFolder& folder,
                      const benchmark::Program& program, const std::vector<benchmark::CellPlan>& plans,
                      benchmark::BenchmarkResults results) {
  std::vector<std::optional<benchmark::CellResult>> cells(plans.size());
  const auto save = [&] {
    results.cells.clear();
    for (const auto& cell : cells) {
      if (cell) {
        results.cells.push_back(*cell);
      }
    }
    formats::write_whole_file(folder.path() / kResultsName, benchmark::to_json(results));
  };
  CellProgress progress(plans.size(), options.quiet);
  benchmark::QueueEvents events;
  events.started = [&](std::size_t plan) { progress.start(name_of(plans[plan].key)); };
  events.ended = [&](std::size_t plan, const benchmark::CellResult& result, bool saved) {
    cells[plan] = result;
    if (!saved) {
      save();
    }
    const std::string outcome = !result.finished          ? "failed: " + result.failure
                                : !result.failure.empty() ? "done, " + result.failure
                                : saved                   ? "done before"
                                                          : "done";
    progress.end(name_of(result.key), outcome, !result.finished);
  };
  benchmark::run_cells(plans, {folder.path(), program.path, options.jobs, options.force}, events);
  save();
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [](const auto& cell) { return !cell || !cell->finished; }));
}

/// The recordings of the command line or of a manifest, whose settings the runs are to have.
benchmark::Sequences open_recordings(BenchmarkOptions& options) {
  if (options.manifest.empty()) {
    return benchmark::open_sequences(options.inputs, options.run.input, options.output);
  }
  const benchmark::Manifest manifest = benchmark::read_manifest(options.manifest);
  benchmark::apply(manifest, options.run.input);
  return benchmark::open_manifest(manifest, options.root, options.run.input, options.output);
}

int run_benchmark(BenchmarkOptions options) {
  const std::vector<Candidate> rivals = choose_candidates(
      options.methods, options.ablations.value_or(options.methods == "all" ? "all" : "none"), options.run);
  const benchmark::Sequences opened = open_recordings(options);
  for (const std::string& reason : opened.skipped) {
    tell("dynamic-icp: warning: left out: {}\n", reason);
  }
  const benchmark::BenchmarkFolder folder(options.output);
  const benchmark::Program program = this_program();
  std::vector<benchmark::CellPlan> plans;
  for (const benchmark::Sequence& sequence : opened.sequences) {
    for (const Candidate& rival : rivals) {
      benchmark::RunSettings run = options.run;
      run.settings = rival.settings;
      plans.push_back(benchmark::plan_cell(program, sequence, rival.method, rival.ablation, run, rival.configuration));
    }
  }
  const std::size_t failed = run_plans(options, folder, program, plans, {describe(options, opened.sequences), {}});
  write_tables(folder.path());
  if (failed > 0) {
    throw DataError(fmt::format("{} of {} cells failed; messages are in {}", failed, plans.size(),
                                (folder.path() / kResultsName).string()));
  }
  return 0;
}

int run(const BenchmarkOptions& options) {
  const bool tables_only = !options.tables.empty();
  const bool from_manifest = !options.manifest.empty();
  const int sources = (tables_only ? 1 : 0) + (from_manifest ? 1 : 0) + (options.inputs.empty() ? 0 : 1);
  if (sources != 1 || tables_only != options.output.empty() || from_manifest == options.root.empty()) {
    throw UsageError(
        "expected INPUT... with --output DIR, or --manifest FILE with --root DIR and --output DIR, or --tables DIR "
        "alone");
  }
  if (tables_only) {
    if (!fs::exists(fs::path(options.tables) / kResultsName)) {
      throw DataError(fmt::format("{}: holds no {}; expected the folder of a benchmark", options.tables, kResultsName));
    }
    write_tables(options.tables);  // also while the benchmark is running: from what is there so far
    return 0;
  }
  return run_benchmark(options);
}

void add_run_settings(CLI::App& command, benchmark::RunSettings& run) {
  add_configuration_options(command, run.preset, run.config_file, run.settings, run.threads);
  add_input_options(command, run.input);
  add_selection_options(command, "process of each recording", run.start, run.max_frames);
}

}  // namespace

void add_benchmark_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<BenchmarkOptions>();
  CLI::App* command = app.add_subcommand(
      "benchmark", "Recordings through all methods under identical preprocessing; the paper's tables");
  command->footer(
      "Resumable: after an interruption the same command goes on where it was. Finished runs whose program, "
      "configuration and "
      "recording are unchanged are not run again; failed ones are.");
  command->add_option("INPUT", options->inputs, "Recordings, or folders whose sub-folders are recordings");
  add_option(*command, "-o,--output", options->output, "DIR",
             "Folder for runs, results.json and tables; new, or that of a benchmark");
  add_option(*command, "--manifest", options->manifest, "FILE",
             "Take the recordings that this list names (manifests/paper-*.yaml: those of the paper), as many of "
             "them as lie below --root");
  add_option(*command, "--root", options->root, "DIR", "Folder of the data set, for --manifest");
  add_option(*command, "--tables", options->tables, "DIR",
             "Only make the tables of this benchmark again, from its results.json");
  add_option(*command, "--methods", options->methods, "LIST",
             fmt::format("Methods, with commas: {} (default all)", fmt::join(known_methods(), ", ")));
  add_option(*command, "--ablations", options->ablations, "LIST",
             fmt::format("Parts of {} to switch off, one at a time: all, none, {} (default: all with --methods all, "
                         "none with methods that "
                         "are named)",
                         benchmark::kOurMethod, fmt::join(known_ablations(), ", ")));
  add_option(*command, "--jobs", options->jobs, "N",
             "Runs at the same time (default 1); more are faster together, but disturb each other's times")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--force", options->force, "Run finished cells again");
  command->add_flag("--quiet", options->quiet, "Print failures and tables only");
  add_run_settings(*command, options->run);
  command->callback([options, &selected] { selected = [options] { return run(*options); }; });
}

}  // namespace dynamic_icp::apps
