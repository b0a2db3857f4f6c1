// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/followed_dataset.hpp"
#include "dynamic_icp/recording/runs/map_writer.hpp"
#include "dynamic_icp/recording/runs/mcap_recorder.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/exit_status.hpp"
#include "apps/input_options.hpp"
#include "apps/live_options.hpp"
#include "apps/messages.hpp"
#include "apps/method_options.hpp"
#include "apps/options.hpp"
#include "apps/process.hpp"
#include "apps/progress.hpp"
#include "apps/run_summary_text.hpp"
#include "apps/scan_selection.hpp"
#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWarningsShown = 5;
constexpr const char* kStopNotice =
    "\ndynamic-icp: stopping after this scan, with the results so far; a second time: at once, without them\n";

struct RunOptions {
  runs::Recording recording;
  runs::RunSettings settings;
  MethodOptions method;
  LiveOptions live;
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

/// What the user is told at the end.
void print_summary(const runs::RunResult& result, const runs::RunSettings& settings, bool reported) {
  print_row("{}", summary_text(result));
  if (result.map_points) {
    print_row("map          {} points in {}\n", *result.map_points, settings.map_file->string());
  }
  if (result.has_mcap) {
    print_row("mcap         {} (Foxglove, Lichtblick; layout {})\n", settings.mcap_file->string(),
              (settings.mcap_file->parent_path() / runs::kFoxgloveLayoutFile).string());
  }
  if (result.has_kitti) {
    print_row("KITTI poses  {}\n", settings.kitti_file->string());
  }
  if (result.scans_selected == 1) {
    print_row("hint         {}\n", kOneScan);
  }
  print_row("written to   {}\n", settings.output.string());
  if (reported) {
    print_row("report       {}\n", (settings.output / "report.html").string());
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
  settings.live = live_view_settings(options.live);
  settings.command = command_line();
  return settings;
}

/// What went wrong, the worst first, and the exit status.
int tell_failures(const runs::RunResult& result, const fs::path& output) {
  int status = 0;
  for (const std::string& failure : result.failures) {
    tell("dynamic-icp: {}: the run is there, but {}\n", output.string(), failure);
    status = kDataOrMachineFailed;
  }
  if (!result.summary.failure.empty()) {
    status = kMostScansLost;
  }
  const int signal = StopOnSignal::signal();
  if (signal != 0) {
    tell("dynamic-icp: stopped after {} of {} scans; results so far in {}\n", result.summary.frames,
         result.scans_selected, output.string());
    status = kEndedBySignal + signal;
  }
  return status;
}

bool is_stream(const RunOptions& options) { return options.recording.path == datasets::kStandardInput; }

int run(const RunOptions& options) {
  const runs::RunSettings settings = settings_of(options);
  if (settings.follow_timeout_s && !(*settings.follow_timeout_s > 0.0)) {
    throw UsageError(fmt::format("--follow-timeout is {} s, expected more than 0", *settings.follow_timeout_s));
  }
  if (is_stream(options) && options.report) {
    throw UsageError("--report reads the scans again, which standard input does not allow");
  }
  Warnings warnings(options.quiet);
  std::optional<Progress> progress;
  std::size_t shown = 0;
  bool reported = false;
  const StopOnSignal stopping(kStopNotice);
  runs::RunCallbacks callbacks;
  callbacks.fix_in_words = [&](const diagnosis::Finding& finding) {
    return fixing_options(finding, options.recording.settings);
  };
  callbacks.warning = [&](const std::string& text) { warnings.show(text); };
  if (!options.quiet) {
    callbacks.listening = tell_where_to_watch;
    callbacks.notice = [](const std::string& text) { tell("dynamic-icp: {}\n", text); };
  }
  if (settings.follow && !options.quiet) {
    tell("following {}; Ctrl-C ends it, with the results so far\n",
         is_stream(options) ? "standard input" : options.recording.path.string());
  }
  callbacks.progress = [&](std::size_t done, std::size_t total) {
    if (done == 0) {
      progress.emplace("odometry", total, options.quiet);
    } else {
      progress->advance(done - shown);
    }
    shown = done;
    if (done == total && total > 0) {
      progress.reset();
    }
  };
  callbacks.stop = [&] {
    if (StopOnSignal::signal() != 0) {
      progress.reset();
    }
    return StopOnSignal::signal() != 0;
  };
  if (options.report) {
    callbacks.add_files = [&](const fs::path& folder) {
      if (StopOnSignal::signal() != 0) {  // whoever waits for the end does not want to wait for a page
        tell("dynamic-icp: no report.html; 'dynamic-icp report {}' makes it\n", settings.output.string());
        return;
      }
      if (!options.quiet) {
        tell("writing report.html ...\n");
      }
      reported = make_report(folder, settings.threads);
    };
  }
  const runs::RunResult result = runs::run_recording(options.recording, settings, callbacks).value();
  if (result.was_complete) {
    print_row("{}: the run is complete, nothing is left to do\n", settings.output.string());
    return 0;
  }
  if (!result.summary.failure.empty()) {
    tell("dynamic-icp: {}\n", result.summary.failure);
  }
  if (!options.quiet) {
    print_summary(result, settings, reported);
    std::fflush(stdout);
  }
  return tell_failures(result, settings.output);
}

}  // namespace

void add_run_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Odometry over a recording: trajectory, objects, statistics");
  command
      ->add_option("INPUT", options->recording.path, "Folder or file of the recording; - with --follow: standard input")
      ->required();
  command->footer(
      "Exit status: 0 done; 1 the data or the machine failed; 2 wrong usage; 3 most scans are lost: there are results, "
      "but the trajectory is a guess; 130 (interrupt) and 143 (terminate): stopped after a scan, with the results so "
      "far. A second signal ends it at once, without results. --resume continues after any of them.");
  command->add_option("-o,--output", options->settings.output, "Folder for the results; must be new or empty")
      ->required()
      ->type_name("DIR");
  add_input_options(*command, options->recording.settings);
  add_option(*command, "--ground-truth", options->settings.ground_truth, "FILE",
             "Poses to compare with: TUM, KITTI or CSV with a header (default: what the recording brings along)");
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
  CLI::Option* mcap = add_option(
      *command, "--mcap", options->settings.mcap_file, "FILE",
      "Write FILE.mcap for Foxglove and Lichtblick: scans with Doppler and labels, poses, paths, objects, status "
      "and deviations over time; foxglove_layout.json beside it arranges them");
  add_live_options(*command, options->live);
  CLI::Option* follow =
      command->add_flag("--follow", options->settings.follow,
                        "Take the scans of INPUT as they come: of a folder or an MCAP file that grows, or of MCAP on "
                        "standard input (INPUT is -), until file or stream ends, Ctrl-C or --max-frames");
  add_option(*command, "--follow-timeout", options->settings.follow_timeout_s, "S",
             "End as if the recording had, once no scan has come for S seconds (default: wait on)")
      ->needs(follow);
  add_option(*command, "--save-kitti", options->settings.kitti_file, "FILE",
             "Write the poses as KITTI has them, FILE.txt: 12 numbers a scan, T_world_sensor row by row");
  add_option(*command, "--calibration", options->settings.calibration, "FILE",
             "What was learned of this sensor in another run with --preset default: its calibration.yaml");
  command->add_flag("--report", options->report,
                    "Write report.html into the results, and the labels that it shows (--save-labels)");
  CLI::Option* resume = command->add_flag(
      "--resume", options->settings.resume,
      "Go on with the run in DIR that ended early, in whatever way, from its last checkpoint, with the same INPUT and "
      "options: ends with the bytes of an unbroken run, but for times of computation. Begins one where there is none");
  resume->excludes(follow);
  resume->excludes(mcap);
  command
      ->add_option("--checkpoint", options->settings.checkpoint_s,
                   fmt::format("Seconds between two checkpoints; 0: after every scan (default {} s)",
                               options->settings.checkpoint_s))
      ->type_name("S")
      ->check(CLI::Range(0.0, 86400.0).description(""));
  command->add_flag("--force", options->settings.replace, "Replace an earlier run in DIR, which may hold nothing else");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return run(*options); }; });
}

}  // namespace dynamic_icp::apps
