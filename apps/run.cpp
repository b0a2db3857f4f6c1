// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/base/version.hpp"
#include "dynamic_icp/datasets/input_settings.hpp"
#include "dynamic_icp/datasets/read_ahead.hpp"
#include "dynamic_icp/formats/output_folder.hpp"
#include "dynamic_icp/formats/tum.hpp"
#include "dynamic_icp/odometry/odometry.hpp"
#include "dynamic_icp/results/map_writer.hpp"
#include "dynamic_icp/results/run_writer.hpp"

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/method_options.hpp"
#include "apps/progress.hpp"
#include "apps/recording_check.hpp"
#include "apps/scan_selection.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWarningsShown = 5;

struct RunOptions {
  std::string input;
  std::string output;
  datasets::InputSettings settings;  ///< what was said about the input
  std::string ground_truth;
  std::size_t start = 0;
  std::optional<std::size_t> max_frames;
  std::optional<std::string> map_file;
  double map_voxel_m = 0.1;
  bool save_labels = false;
  bool report = false;
  bool force = false;
  bool quiet = false;
  MethodOptions method;
};

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

/// What was found and done about the time that scans take: as in the first usable scan, and whether the others agree.
struct SweepRecord {
  std::optional<odometry::SweepReport> first;
  bool same_times = true;
  bool all_undone = true;

  void add(const odometry::Frame& frame, const RawScan& scan) {
    if (frame.status == odometry::FrameStatus::kTooFewPoints) {
      return;
    }
    const odometry::SweepReport report = frame.sweep.value_or(odometry::sweep_in_data(scan));
    first = first.value_or(report);
    same_times = same_times && report.times == first->times;
    all_undone = all_undone && report.undone;
  }

  [[nodiscard]] bool undone() const { return first && all_undone; }

  [[nodiscard]] std::string times() const {
    if (!same_times) {
      return "mixed";
    }
    switch (first.value_or(odometry::SweepReport{}).times) {
      case odometry::SweepTimes::kInData:
        return "in the data";
      case odometry::SweepTimes::kDeclared:
        return "declared";
      case odometry::SweepTimes::kNone:
        break;
    }
    return "none";
  }

  [[nodiscard]] std::optional<double> duration_s() const { return first ? first->duration_s : std::nullopt; }
};

nlohmann::ordered_json sweep_json(const SweepRecord& sweep) {
  nlohmann::ordered_json json = {{"times", sweep.times()}, {"duration_s", nullptr}, {"undone", sweep.undone()}};
  if (sweep.duration_s()) {
    json["duration_s"] = *sweep.duration_s();
  }
  return json;
}

nlohmann::ordered_json map_json(const std::optional<results::MapWriter>& map, const RunOptions& options) {
  if (!map) {
    return nullptr;
  }
  return {{"path", fs::absolute(*options.map_file).string()},
          {"points", map->size()},
          {"voxel_size_m", options.map_voxel_m}};
}

nlohmann::ordered_json input_json(const datasets::InputSettings& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, text] : datasets::texts(settings)) {
    json[name] = text;
  }
  return json;
}

nlohmann::ordered_json configuration_json(odometry::Config config) {
  nlohmann::ordered_json json;
  for (const ConfigField& field : odometry::fields(config)) {
    std::visit([&](const auto* value) { json[field.key] = *value; }, field.value);
  }
  return json;
}

struct Warnings {
  std::vector<std::string> texts;
  bool quiet = false;

  void add(const std::string& text) {
    texts.push_back(text);
    if (!quiet && texts.size() <= kWarningsShown) {
      fmt::print(stderr, "dynamic-icp: warning: {}\n", text);
    }
    if (!quiet && texts.size() == kWarningsShown + 1) {
      fmt::print(stderr, "dynamic-icp: more warnings are in run.json\n");
    }
  }
};

/// What a run found and made beside the files of every run.
struct Findings {
  Warnings warnings;
  RecordingCheck recording;
  std::vector<std::string> assumptions;
  SweepRecord sweep;
  std::optional<results::MapWriter> map;
};

std::string run_json(const RunOptions& options, const datasets::Dataset& dataset, const odometry::Config& config,
                     const fs::path& ground_truth, const Findings& findings) {
  nlohmann::ordered_json json = {{"version", version()},
                                 {"command", command_line()},
                                 {"input",
                                  {{"path", fs::absolute(options.input).string()},
                                   {"format", dataset.format()},
                                   {"options", input_json(options.settings)},
                                   {"scans", dataset.size()}}},
                                 {"method", options.method.method},
                                 {"preset", options.method.preset},
                                 {"ablation", options.method.ablation},
                                 {"start", options.start},
                                 {"threads", options.method.threads}};
  json["max_frames"] = nullptr;
  if (options.max_frames) {
    json["max_frames"] = *options.max_frames;
  }
  json["ground_truth"] = nullptr;
  if (!ground_truth.empty()) {
    json["ground_truth"] = fs::absolute(ground_truth).string();
  }
  json["sweep"] = sweep_json(findings.sweep);
  json["doppler"] = findings.recording.doppler;
  json["map"] = map_json(findings.map, options);
  json["assumptions"] = findings.assumptions;
  json["warnings"] = findings.warnings.texts;
  json["configuration"] = configuration_json(config);
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100.0 * *share) : "-";
}

std::string sweep_text(const SweepRecord& sweep) {
  if (sweep.times() == "none") {
    return "none: the points have no times";
  }
  return fmt::format("{}, {} s, times {}", sweep.undone() ? "undone" : "not undone", cell(sweep.duration_s(), 3),
                     sweep.times());
}

void print_summary(const results::RunSummary& summary, const Findings& findings, const RunOptions& options) {
  const evaluation::RunAccuracy& accuracy = summary.accuracy;
  fmt::print("scans        {}\n", summary.frames);
  if (findings.recording.period_s > 0.0) {
    fmt::print("rate         {:.2f} Hz\n", 1.0 / findings.recording.period_s);
  }
  fmt::print("Doppler      {}\n", findings.recording.doppler);
  fmt::print("sweep        {}\n", sweep_text(findings.sweep));
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
  if (findings.map) {
    fmt::print("map          {} points in {}\n", findings.map->size(), *options.map_file);
  }
  fmt::print("written to   {}\n", options.output);
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

void process_scans(const datasets::Dataset& dataset, const ScanSelection& selection, odometry::Odometry& odometry,
                   results::RunWriter& writer, const RunOptions& options, Findings& findings) {
  Progress progress("odometry", selection.end - selection.begin, findings.warnings.quiet);
  datasets::ReadAhead scans(dataset, selection.begin, selection.end);
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
      findings.map->add(frame);
    }
    progress.advance();
  }
  refuse_without_points(usability, options);
}

/// A page that cannot be made is no reason to lose the run. Whether it was made.
bool try_to_report(const fs::path& folder, const RunOptions& options) {
  try {
    write_report(folder, folder / "report.html", options.method.threads);
    return true;
  } catch (const std::exception& error) {
    fmt::print(stderr, "dynamic-icp: warning: no report.html: {}\n", error.what());
    return false;
  }
}

int run(const RunOptions& options) {
  const odometry::Config config = make_config(options.method);
  Findings findings{{{}, options.quiet}, {}, {}, {}, make_map(options)};
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(options.input, options.settings);
  const ScanSelection selection = select_scans(*dataset, options.start, options.max_frames);
  findings.recording = check_recording(*dataset, options.settings, selection.begin, selection.end,
                                       odometry::needs_doppler(options.method.method), options.method.threads);
  const bool own_truth = options.ground_truth.empty();
  const fs::path truth_file = own_truth ? dataset->ground_truth_file() : fs::path(options.ground_truth);
  const formats::Trajectory truth =
      own_truth ? dataset->ground_truth() : formats::read_tum(options.ground_truth).trajectory;
  formats::OutputFolder output(options.output, "run.json", options.force);
  const fs::path map_file =
      findings.map ? results::map_destination(*options.map_file, options.output, output.path()) : fs::path();

  const std::unique_ptr<odometry::Odometry> odometry = odometry::make_odometry(
      options.method.method, config, {dataset->T_vehicle_sensor(), dataset->doppler_kind()}, options.method.threads);
  findings.assumptions = dataset->assumptions();
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
  process_scans(*dataset, selection, *odometry, writer, options, findings);
  const results::RunSummary summary = writer.finish(options.method.method, truth, findings.assumptions,
                                                    run_json(options, *dataset, config, truth_file, findings));
  const bool reported = options.report && try_to_report(output.path(), options);
  if (findings.map) {
    findings.map->write(map_file);
  }
  output.commit();
  if (!options.quiet) {
    print_summary(summary, findings, options);
    if (reported) {
      fmt::print("report       {}\n", (fs::path(options.output) / "report.html").string());
    }
  }
  return 0;
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
  command->add_flag("--force", options->force, "Replace an earlier run in DIR");
  command->add_flag("--quiet", options->quiet, "Print errors only");
  add_method_options(*command, options->method);
  command->callback([options, &selected] { selected = [options] { return run(*options); }; });
}

}  // namespace dynamic_icp::apps
