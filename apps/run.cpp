// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/read_ahead.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/results/map_writer.hpp"
#include "dynamic_icp/tools/results/run_writer.hpp"

#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/messages.hpp"
#include "apps/method_options.hpp"
#include "apps/progress.hpp"
#include "apps/recording_check.hpp"
#include "apps/result_kinds.hpp"
#include "apps/run_record.hpp"
#include "apps/scan_selection.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

/// The map to be made, if one is asked for. What cannot be is refused before anything is computed.
std::optional<results::MapWriter> make_map(const RunOptions& options) {
  if (!options.map_file) {
    return std::nullopt;
  }
  results::check_map_file(*options.map_file);
  if (options.method.method != "dynamic-icp") {
    throw UsageError(fmt::format("--save-map: only dynamic-icp tells static points from moving ones, {} does not",
                                 options.method.method));
  }
  return results::MapWriter(options.map_voxel_m);
}

/// What became of the points of a run, to tell why nothing came of it.
struct Usability {
  std::size_t frames = 0;
  std::size_t unusable = 0;  ///< frames with too few points to work with
  std::size_t points = 0;
  std::size_t points_used = 0;
  Scan::Dropped dropped;

  void add(const odometry::Frame& frame) {
    ++frames;
    unusable += frame.status == odometry::FrameStatus::kTooFewPoints ? 1 : 0;
    points += frame.points;
    points_used += frame.points_used;
    dropped += frame.dropped;
  }
};

/// A trajectory of poses that nobody saw is no result. Throws DataError when not one scan could be used.
void refuse_without_points(const Usability& seen, const RunOptions& options) {
  if (seen.unusable < seen.frames) {
    return;
  }
  throw DataError(
      fmt::format("{}: none of the {} scans has enough points to work with: of {} points {} have numbers that are not "
                  "finite, {} have numbers that no sensor measures, {} are at the origin, {} out of range, {} remain "
                  "after thinning. 'dynamic-icp info' says more",
                  options.input, seen.frames, seen.points, seen.dropped.non_finite, seen.dropped.implausible,
                  seen.dropped.zero_range, seen.dropped.out_of_range, seen.points_used));
}

/// What is run over what.
struct RunTask {
  const RunOptions& options;
  odometry::Config config;
  std::unique_ptr<datasets::Dataset> dataset;
  ScanSelection selection;
  fs::path truth_file;
  formats::Trajectory truth;
};

/// A map that cannot be is no reason to lose the run.
void add_to_map(const odometry::Frame& frame, Findings& findings) {
  try {
    findings.map->add(frame);
  } catch (const std::exception& error) {
    findings.fail(fmt::format("no map: {}", error.what()));
    findings.map.reset();
  }
}

void process_scans(const RunTask& task, odometry::Odometry& odometry, results::RunWriter& writer, Findings& findings) {
  const ScanSelection& selection = task.selection;
  Progress progress("odometry", selection.end - selection.begin, findings.warnings.quiet);
  datasets::ReadAhead scans(*task.dataset, selection.begin, selection.end);
  Usability usability;
  for (std::size_t i = selection.begin; i < selection.end; ++i) {
    const RawScan scan = scans.next();
    if (!scan.warning.empty()) {
      findings.warnings.add(scan.warning);
    }
    const odometry::Frame frame = odometry.process(scan);
    writer.add(i, frame);
    usability.add(frame);
    findings.sweep.add(frame, scan);
    if (findings.map) {
      add_to_map(frame, findings);
    }
    progress.advance();
  }
  refuse_without_points(usability, task.options);
}

/// Writes the map, if there is one; whether nothing failed.
bool try_to_write_map(const fs::path& path, const formats::OutputFolder& output, Findings& findings) {
  try {
    if (findings.map) {
      findings.map->write(path);
    }
    return true;
  } catch (const std::exception& error) {
    findings.fail("no map: " + output.in_final_names(error.what()));
    findings.map.reset();
    return false;
  }
}

/// A page that cannot be made is no reason to lose the run.
void try_to_report(const formats::OutputFolder& output, const RunOptions& options, Findings& findings) {
  try {
    write_report(output.path(), output.path() / "report.html", options.method.threads);
    findings.reported = true;
  } catch (const std::exception& error) {
    const std::string text = "no report.html: " + output.in_final_names(error.what());
    if (has_viewer()) {
      findings.fail(text);
    } else {
      tell("dynamic-icp: warning: {}\n", text);
    }
  }
}

/// All files of the run into the folder where it is put together.
results::RunSummary write_run(const RunTask& task, const formats::OutputFolder& output, Findings& findings) {
  const RunOptions& options = task.options;
  const datasets::Dataset& dataset = *task.dataset;
  const fs::path map_file =
      findings.map ? results::map_destination(*options.map_file, options.output, output.path()) : fs::path();
  const fs::path map_in_run =
      formats::lies_in(map_file, output.path()) ? map_file.lexically_relative(output.path()) : "";
  const std::unique_ptr<odometry::Odometry> odometry = odometry::make_odometry(
      task.config, {dataset.T_vehicle_sensor(), dataset.doppler_kind()}, options.method.threads);
  findings.assumptions = dataset.assumptions();
  for (const std::string& assumption : odometry->assumptions()) {
    findings.assumptions.push_back(assumption);
  }
  for (const std::string& assumption : findings.assumptions) {
    findings.warnings.add(assumption);
  }
  for (const std::string& doubt : findings.recording.warnings) {
    findings.warnings.add(doubt);
  }
  results::RunWriter writer(output.path(), options.save_labels || options.report);
  process_scans(task, *odometry, writer, findings);
  const auto record = [&] { return run_json(options, dataset, task.config, task.truth_file, findings, map_in_run); };
  const results::RunSummary summary = writer.finish(options.method.method, task.truth, findings.assumptions, record());
  // Last, for an earlier map is only replaced by that of a run that is whole.
  if (!try_to_write_map(map_file, output, findings)) {
    formats::write_whole_file(output.path() / "run.json", record());
  }
  if (options.report) {
    try_to_report(output, options, findings);
  }
  return summary;
}

RunTask open_task(const RunOptions& options) {
  RunTask task{options, make_config(options.method), datasets::open_input(options.input, options.settings), {}, {}, {}};
  task.selection = select_scans(*task.dataset, options.start, options.max_frames);
  const bool own_truth = options.ground_truth.empty();
  task.truth_file = own_truth ? task.dataset->ground_truth_file() : fs::path(options.ground_truth);
  task.truth = own_truth ? task.dataset->ground_truth() : formats::read_tum(options.ground_truth).trajectory;
  return task;
}

int run(const RunOptions& options) {
  Findings findings;
  findings.warnings.quiet = options.quiet;
  findings.map = make_map(options);
  const RunTask task = open_task(options);
  findings.recording = check_recording(*task.dataset, options.settings, task.selection.begin, task.selection.end,
                                       odometry::needs_doppler(options.method.method), options.method.threads);
  formats::OutputFolder output(
      options.output, run_result(), options.force,
      {options.input, task.dataset->scan_file(task.selection.begin), task.truth_file, options.method.config_file});
  const results::RunSummary summary = output.fill([&] { return write_run(task, output, findings); });
  output.commit();
  if (!options.quiet) {
    print_summary(summary, findings, options);
  }
  for (const std::string& failure : findings.failures) {
    tell("dynamic-icp: {}: the run is there, but {}\n", options.output, failure);
  }
  return findings.failures.empty() ? 0 : 1;
}

}  // namespace

void add_run_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Odometry over a recording: trajectory, objects, statistics");
  command->add_option("INPUT", options->input, "Folder of the recording")->required();
  command->add_option("--output", options->output, "Folder for the results; must be new or empty")
      ->required()
      ->type_name("DIR");
  add_input_options(*command, options->settings);
  command
      ->add_option("--ground-truth", options->ground_truth,
                   "TUM file to compare with (default: what the recording brings along)")
      ->type_name("FILE");
  add_selection_options(*command, "process", options->start, options->max_frames);
  command->add_flag("--save-labels", options->save_labels, "Write labels/*.bin: static, object or unused per point");
  CLI::Option* save_map =
      command
          ->add_option("--save-map", options->map_file,
                       "Write the static points of all scans in world axes as one point cloud, FILE.ply or FILE.pcd "
                       "(dynamic-icp only)")
          ->type_name("FILE");
  command
      ->add_option(
          "--map-voxel", options->map_voxel_m,
          fmt::format("Edge of the voxels of which the map keeps the first point, {} to {} m (default {} m)",
                      results::MapWriter::kMinVoxelSize_m, results::MapWriter::kMaxVoxelSize_m, options->map_voxel_m))
      ->type_name("M")
      ->needs(save_map);
  command->add_flag("--report", options->report,
                    "Write report.html into the results, and the labels that it shows (--save-labels)");
  command->add_flag("--force", options->force, "Replace an earlier run in DIR, which may hold nothing else");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return run(*options); }; });
}

}  // namespace dynamic_icp::apps
