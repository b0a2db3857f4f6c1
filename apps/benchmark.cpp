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
#include "dynamic_icp/tools/benchmark/cell_plan.hpp"
#include "dynamic_icp/tools/benchmark/cell_queue.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"
#include "dynamic_icp/tools/benchmark/manifest.hpp"
#include "dynamic_icp/tools/benchmark/plan_file.hpp"
#include "dynamic_icp/tools/benchmark/sequences.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"

#include "apps/benchmark_tables.hpp"
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

struct BenchmarkOptions {
  std::vector<std::string> inputs;
  std::string manifest;
  std::string root;
  std::string output;
  std::string tables;
  bool plan = false;  ///< the cells are listed for others to run
  std::string cell;   ///< the one of a plan to run
  std::string collect;
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

std::string name_of(const benchmark::CellKey& key) {
  return key.sequence + " " + key.method + (key.ablation == "none" ? "" : " " + key.ablation);
}

void save(const benchmark::BenchmarkResults& results, const benchmark::BenchmarkFolder& folder) {
  formats::write_whole_file(folder.path() / benchmark::kResultsName, benchmark::to_json(results));
}

std::string outcome_of(const benchmark::CellResult& result, bool saved) {
  return !result.finished          ? "failed: " + result.failure
         : !result.failure.empty() ? "done, " + result.failure
         : saved                   ? "done before"
                                   : "done";
}

/// Throws DataError when there are failed cells.
void fail_with(std::size_t failed, std::size_t cells, const benchmark::BenchmarkFolder& folder) {
  if (failed > 0) {
    throw DataError(fmt::format("{} of {} cells failed; messages are in {}", failed, cells,
                                (folder.path() / benchmark::kResultsName).string()));
  }
}

/// Runs the cells and saves results.json after each of them; how many failed.
std::size_t run_plans(const BenchmarkOptions& options, const benchmark::BenchmarkFolder& folder,
                      const benchmark::Program& program, const std::vector<benchmark::CellPlan>& plans,
                      benchmark::BenchmarkResults results) {
  std::vector<std::optional<benchmark::CellResult>> cells(plans.size());
  const auto save_ended = [&] {
    results.cells.clear();
    for (const auto& cell : cells) {
      if (cell) {
        results.cells.push_back(*cell);
      }
    }
    save(results, folder);
  };
  CellProgress progress(plans.size(), options.quiet);
  benchmark::QueueEvents events;
  events.started = [&](std::size_t plan) { progress.start(name_of(plans[plan].key)); };
  events.ended = [&](std::size_t plan, const benchmark::CellResult& result, bool saved) {
    cells[plan] = result;
    if (!saved) {
      save_ended();
    }
    progress.end(name_of(result.key), outcome_of(result, saved), !result.finished);
  };
  benchmark::run_cells(plans, {folder.path(), program.path, options.jobs, options.force}, events);
  save_ended();
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
  for (const benchmark::Skipped& skipped : opened.skipped) {
    tell("dynamic-icp: warning: left out: {}\n", with_options(skipped.reason, skipped.proposal));
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
  const benchmark::BenchmarkResults none = {describe(options, opened.sequences), {}};
  if (options.plan) {
    save(none, folder);
    benchmark::write_plan(folder.path(), program, plans);
    tell("dynamic-icp: {} cells in {}\n", plans.size(), (folder.path() / benchmark::kPlanName).string());
    return 0;
  }
  const std::size_t failed = run_plans(options, folder, program, plans, none);
  write_tables(folder.path());
  fail_with(failed, plans.size(), folder);
  return 0;
}

/// Beside others that run other cells of the same plan.
int run_cell(const BenchmarkOptions& options) {
  const benchmark::PlanFile plan = benchmark::read_plan(options.output);
  const benchmark::CellPlan& cell = benchmark::find_cell(plan, options.cell);
  const benchmark::Program program = this_program();
  if (program.checksum != plan.checksum) {
    throw DataError(
        fmt::format("{}: made by another build of dynamic-icp, version {}; expected this one, make the plan "
                    "again",
                    (fs::path(options.output) / benchmark::kPlanName).string(), plan.version));
  }
  const benchmark::BenchmarkFolder folder(options.output, benchmark::FolderLock::Kind::kWithOthers);
  formats::make_folder(folder.path() / cell.folder);
  const benchmark::FolderLock lock(folder.path() / cell.folder, "cell.lock", benchmark::FolderLock::Kind::kAlone);
  CellProgress progress(1, options.quiet);
  bool finished = false;
  benchmark::QueueEvents events;
  events.started = [&](std::size_t) { progress.start(name_of(cell.key)); };
  events.ended = [&](std::size_t, const benchmark::CellResult& result, bool saved) {
    finished = result.finished;
    progress.end(name_of(cell.key), outcome_of(result, saved), !finished);
  };
  benchmark::run_cells({cell}, {folder.path(), program.path, 1, options.force}, events);
  return finished ? 0 : 1;
}

/// The results and tables of cells that ran one by one.
int collect(const fs::path& path) {
  const benchmark::PlanFile plan = benchmark::read_plan(path);
  const benchmark::BenchmarkFolder folder(path);
  const fs::path source = folder.path() / benchmark::kResultsName;
  benchmark::BenchmarkResults results = benchmark::results_from_json(formats::read_text_file(source), source);
  results.cells = benchmark::collect_results(folder.path(), plan);
  save(results, folder);
  write_tables(folder.path());
  const auto failed = std::count_if(results.cells.begin(), results.cells.end(),
                                    [](const benchmark::CellResult& cell) { return !cell.finished; });
  fail_with(static_cast<std::size_t>(failed), results.cells.size(), folder);
  return 0;
}

int run(const BenchmarkOptions& options) {
  const bool one_cell = !options.cell.empty();
  const bool in_folder = !options.tables.empty() || !options.collect.empty();
  const bool from_manifest = !options.manifest.empty();
  const int sources = (options.tables.empty() ? 0 : 1) + (options.collect.empty() ? 0 : 1) + (one_cell ? 1 : 0) +
                      (from_manifest ? 1 : 0) + (options.inputs.empty() ? 0 : 1);
  if (sources != 1 || in_folder != options.output.empty() || from_manifest == options.root.empty() ||
      (options.plan && (in_folder || one_cell))) {
    throw UsageError(
        "expected INPUT... with --output DIR, or --manifest FILE with --root DIR and --output DIR, either of them with "
        "--plan where others run the cells; or --cell CELL with --output DIR; or --collect DIR or --tables DIR alone");
  }
  if (!options.tables.empty()) {
    write_tables(options.tables);  // also while the benchmark is running: from what is there so far
    return 0;
  }
  if (!options.collect.empty()) {
    return collect(options.collect);
  }
  return one_cell ? run_cell(options) : run_benchmark(options);
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
      "Resumable: after an interruption the same command continues where it was. Finished runs whose program, "
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
  command->add_flag("--plan", options->plan,
                    "Run nothing: list the runs in plan.json, for a workflow engine to have them run by --cell");
  add_option(*command, "--cell", options->cell, "CELL",
             "Run this cell of the plan alone, SEQUENCE/METHOD or SEQUENCE/METHOD_ABLATION; others at the same time");
  add_option(*command, "--collect", options->collect, "DIR",
             "Make results.json and the tables from the cells of a plan that have been run");
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
