// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/runs/map_writer.hpp"
#include "dynamic_icp/recording/runs/mcap_recorder.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/messages.hpp"
#include "apps/method_options.hpp"
#include "apps/options.hpp"
#include "apps/progress.hpp"
#include "apps/scan_selection.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWarningsShown = 5;

struct RunOptions {
  runs::Recording recording;
  runs::RunSettings settings;
  MethodOptions method;
  bool report = false;
  bool quiet = false;
};

/// Prints the first few warnings as they come; all are in run.json.
class Warnings {
 public:
  explicit Warnings(bool quiet) : quiet_(quiet) {}

  void show(const std::string& text) {
    ++count_;
    if (!quiet_ && count_ <= kWarningsShown) {
      tell("dynamic-icp: warning: {}\n", text);
    }
    if (!quiet_ && count_ == kWarningsShown + 1) {
      tell("dynamic-icp: more warnings are in run.json\n");
    }
  }

 private:
  bool quiet_;
  std::size_t count_ = 0;
};

/// Whether it was made. Without the viewer that is no failure of the run.
bool make_report(const fs::path& folder, int threads) {
  try {
    write_report(folder, folder / "report.html", threads);
    return true;
  } catch (const std::exception& error) {
    const std::string text = fmt::format("no report.html: {}", error.what());
    if (has_viewer()) {
      throw DataError(text);
    }
    tell("dynamic-icp: warning: {}\n", text);
    return false;
  }
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100.0 * *share) : "-";
}

std::string sweep_text(const runs::SweepRecord& sweep) {
  if (sweep.times() == "none") {
    return sweep.search ? sweep.search->sentence : "none: the points have no times";
  }
  return fmt::format("{}, {} s, times {}", sweep.deskewed() ? "deskewed" : "not deskewed", cell(sweep.duration_s(), 3),
                     sweep.times());
}

/// What the user is told at the end.
void print_summary(const runs::RunResult& result, const runs::RunSettings& settings, bool reported) {
  const runs::RunSummary& summary = result.summary;
  const evaluation::RunAccuracy& accuracy = summary.accuracy;
  fmt::print("scans        {}\n", summary.frames);
  if (result.period_s > 0.0) {
    fmt::print("rate         {:.2f} Hz\n", 1.0 / result.period_s);
  }
  fmt::print("Doppler      {}\n", result.doppler);
  fmt::print("sweep        {}\n", sweep_text(result.sweep));
  fmt::print("converged    {}   iterations {}\n", percent(summary.convergence_rate), cell(summary.mean_iterations, 1));
  fmt::print("time         {} ms a scan (median {}, p95 {})\n", cell(summary.ms_mean, 1), cell(summary.ms_median, 1),
             cell(summary.ms_p95, 1));
  fmt::print("dynamic      {} of the points, {} of them clustered\n", percent(summary.dynamic_ratio_mean),
             percent(summary.clustered_ratio_mean));
  if (accuracy.matched > 0) {
    fmt::print("RTE          {} m RMSE, {} m median (frame to frame)\n", cell(accuracy.rte_rmse_m, 4),
               cell(accuracy.rte_median_m, 4));
    fmt::print("RRE          {} deg RMSE, {} deg median\n", cell(accuracy.rre_rmse_deg, 4),
               cell(accuracy.rre_median_deg, 4));
    fmt::print("ATE          {} m RMSE over {} m (SE(3) aligned, {} of {} poses matched)\n",
               cell(accuracy.ate_rmse_m, 3), cell(accuracy.path_length_m, 1), accuracy.matched, summary.frames);
  }
  for (const auto& [status, count] : summary.status_counts) {
    if (status != "first" && status != "converged") {
      fmt::print("note         {} scan{} with status {}\n", count, count == 1 ? "" : "s", status);
    }
  }
  if (result.map_points) {
    fmt::print("map          {} points in {}\n", *result.map_points, settings.map_file->string());
  }
  if (result.has_mcap) {
    fmt::print("mcap         {} (Foxglove, Lichtblick; layout {})\n", settings.mcap_file->string(),
               (settings.mcap_file->parent_path() / runs::kFoxgloveLayoutFile).string());
  }
  if (result.has_kitti) {
    fmt::print("KITTI poses  {}\n", settings.kitti_file->string());
  }
  fmt::print("written to   {}\n", settings.output.string());
  if (reported) {
    fmt::print("report       {}\n", (settings.output / "report.html").string());
  }
}

/// The settings of the run with what the options of the method mean.
runs::RunSettings settings_of(const RunOptions& options) {
  runs::RunSettings settings = options.settings;
  settings.config = make_config(options.method);
  settings.method = options.method.method;
  settings.preset = options.method.preset;
  settings.ablation = options.method.ablation;
  settings.threads = options.method.threads;
  settings.save_labels = settings.save_labels || options.report;
  settings.inputs = {options.method.config_file};
  settings.command = command_line();
  return settings;
}

int run(const RunOptions& options) {
  const runs::RunSettings settings = settings_of(options);
  Warnings warnings(options.quiet);
  std::optional<Progress> progress;
  bool reported = false;
  runs::RunCallbacks callbacks;
  callbacks.fix_in_words = fixing_options;
  callbacks.warning = [&](const std::string& text) { warnings.show(text); };
  callbacks.progress = [&](std::size_t done, std::size_t total) {
    if (done == 0) {
      progress.emplace("odometry", total, options.quiet);
    } else {
      progress->advance();
    }
    if (done == total) {
      progress.reset();
    }
  };
  if (options.report) {
    callbacks.add_files = [&](const fs::path& folder) { reported = make_report(folder, settings.threads); };
  }
  const runs::RunResult result = runs::run_recording(options.recording, settings, callbacks).value();
  if (!options.quiet) {
    print_summary(result, settings, reported);
  }
  for (const std::string& failure : result.failures) {
    tell("dynamic-icp: {}: the run is there, but {}\n", settings.output.string(), failure);
  }
  return result.failures.empty() ? 0 : 1;
}

}  // namespace

void add_run_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Odometry over a recording: trajectory, objects, statistics");
  command->add_option("INPUT", options->recording.path, "Folder of the recording")->required();
  command->add_option("--output", options->settings.output, "Folder for the results; must be new or empty")
      ->required()
      ->type_name("DIR");
  add_input_options(*command, options->recording.settings);
  add_option(*command, "--ground-truth", options->settings.ground_truth, "FILE",
             "TUM file to compare with (default: what the recording brings along)");
  add_selection_options(*command, "process", options->settings.start, options->settings.max_frames);
  command->add_flag("--save-labels", options->settings.save_labels,
                    "Write labels/*.bin: static, object or unused per point");
  CLI::Option* save_map =
      add_option(*command, "--save-map", options->settings.map_file, "FILE",
                 "Write the static points of all scans in world axes as one point cloud, FILE.ply or FILE.pcd "
                 "(dynamic-icp only)");
  add_option(
      *command, "--map-voxel", options->settings.map_voxel_m, "M",
      fmt::format("Edge of the voxels of which the map keeps the first point, {} to {} m (default {} m)",
                  runs::MapWriter::kMinVoxelSize_m, runs::MapWriter::kMaxVoxelSize_m, options->settings.map_voxel_m))
      ->needs(save_map);
  add_option(
      *command, "--mcap", options->settings.mcap_file, "FILE",
      "Write FILE.mcap for Foxglove and Lichtblick: scans with Doppler and labels, poses, paths, objects, status "
      "and deviations over time; foxglove_layout.json beside it arranges them");
  add_option(*command, "--save-kitti", options->settings.kitti_file, "FILE",
             "Write the poses as KITTI has them, FILE.txt: 12 numbers a scan, T_world_sensor row by row");
  add_option(*command, "--calibration", options->settings.calibration, "FILE",
             "What was learned of this sensor in another run with --preset default: its calibration.yaml");
  command->add_flag("--report", options->report,
                    "Write report.html into the results, and the labels that it shows (--save-labels)");
  command->add_flag("--force", options->settings.replace, "Replace an earlier run in DIR, which may hold nothing else");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return run(*options); }; });
}

}  // namespace dynamic_icp::apps
