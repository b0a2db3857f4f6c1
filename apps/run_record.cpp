// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/run_record.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/version.hpp"

#include "apps/command_line.hpp"
#include "apps/messages.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWarningsShown = 5;

nlohmann::ordered_json sweep_json(const SweepRecord& sweep) {
  nlohmann::ordered_json json = {{"times", sweep.times()}, {"duration_s", nullptr}, {"undone", sweep.undone()}};
  if (sweep.duration_s()) {
    json["duration_s"] = *sweep.duration_s();
  }
  return json;
}

nlohmann::ordered_json map_json(const std::optional<results::MapWriter>& map, const RunOptions& options,
                                const fs::path& map_in_run) {
  if (!map) {
    return nullptr;
  }
  nlohmann::ordered_json json = {{"path", fs::absolute(*options.map_file).string()},
                                 {"file_in_run", nullptr},
                                 {"points", map->size()},
                                 {"voxel_size_m", options.map_voxel_m}};
  if (!map_in_run.empty()) {
    json["file_in_run"] = map_in_run.generic_string();
  }
  return json;
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

}  // namespace

void SweepRecord::add(const odometry::Frame& frame, const RawScan& scan) {
  if (frame.status == odometry::FrameStatus::kTooFewPoints) {
    return;
  }
  const motion::SweepReport report = frame.sweep.value_or(motion::sweep_in_data(scan));
  first = first.value_or(report);
  same_times = same_times && report.times == first->times;
  all_undone = all_undone && report.undone;
}

std::string SweepRecord::times() const {
  if (!same_times) {
    return "mixed";
  }
  switch (first.value_or(motion::SweepReport{}).times) {
    case motion::SweepTimes::kInData:
      return "in the data";
    case motion::SweepTimes::kDeclared:
      return "declared";
    case motion::SweepTimes::kNone:
      break;
  }
  return "none";
}

void Warnings::add(const std::string& text) {
  texts.push_back(text);
  if (!quiet && texts.size() <= kWarningsShown) {
    tell("dynamic-icp: warning: {}\n", text);
  }
  if (!quiet && texts.size() == kWarningsShown + 1) {
    tell("dynamic-icp: more warnings are in run.json\n");
  }
}

std::string run_json(const RunOptions& options, const datasets::Dataset& dataset, const odometry::Config& config,
                     const fs::path& ground_truth, const Findings& findings, const fs::path& map_in_run) {
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
  json["map"] = map_json(findings.map, options, map_in_run);
  json["assumptions"] = findings.assumptions;
  json["warnings"] = findings.warnings.texts;
  json["configuration"] = configuration_json(config);
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
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
  if (findings.reported) {
    fmt::print("report       {}\n", (fs::path(options.output) / "report.html").string());
  }
}

}  // namespace dynamic_icp::apps
