// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include "apps/bag_info.hpp"
#include "apps/calibration_info.hpp"
#include "apps/commands.hpp"
#include "apps/input_options.hpp"
#include "apps/recording_look.hpp"
#include "apps/sweep_advice.hpp"
#include "apps/terminal.hpp"

namespace dynamic_icp::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kGapsShown = 5;
constexpr std::size_t kSentenceColumn = 30;  // of the diagnosis, behind question and verdict

struct InfoOptions {
  std::string input;
  datasets::InputSettings settings;
  bool json = false;
};

void print_time(const datasets::Dataset& dataset, const TimesSeen& seen) {
  if (dataset.size() == 0) {
    return;
  }
  if (seen.periods == 0) {
    print_row("time         one scan at {} s\n", format_seconds(dataset.stamp(0)));
    return;
  }
  print_row("time         {} to {} s, {:.3f} s in all\n", format_seconds(dataset.stamp(0)),
            format_seconds(dataset.stamp(dataset.size() - 1)),
            seconds_between(dataset.stamp(0), dataset.stamp(dataset.size() - 1)));
  print_row("rate         {:.2f} Hz (periods {:.1f} to {:.1f} ms)\n", 1.0 / seen.period_s, 1e3 * seen.shortest_s,
            1e3 * seen.longest_s);
  for (std::size_t i = 0; i < std::min(kGapsShown, seen.gaps.size()); ++i) {
    print_row("gap          {:.3f} s before scan {}\n", seen.gaps[i].second, seen.gaps[i].first);
  }
  if (seen.gaps.size() > kGapsShown) {
    print_row("gap          {} more\n", seen.gaps.size() - kGapsShown);
  }
}

double yaw_deg(const Eigen::Isometry3d& T) {
  return std::atan2(T.linear()(1, 0), T.linear()(0, 0)) * 180.0 / std::numbers::pi;
}

/// The axes about which the lever arms of the sensors make a rotation visible in the Doppler, as columns, and root mean
/// square of the lever arms about each (m), ascending: none about the line through two sensors.
Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> lever_arms(const std::vector<Eigen::Isometry3d>& mountings) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& T : mountings) {
    middle += T.translation() / static_cast<double>(mountings.size());
  }
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Isometry3d& T : mountings) {
    const Eigen::Matrix3d lever = skew(T.translation() - middle);
    squares += lever.transpose() * lever / static_cast<double>(mountings.size());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares);
}

void print_rig(const std::vector<Eigen::Isometry3d>& mountings) {
  if (mountings.empty()) {
    return;
  }
  for (std::size_t k = 0; k < mountings.size(); ++k) {
    const Eigen::Vector3d t = mountings[k].translation();
    print_row("sensor {}     at ({:.3f}, {:.3f}, {:.3f}) m, yaw {:.1f} deg\n", k, t.x(), t.y(), t.z(),
              yaw_deg(mountings[k]));
  }
  const auto levers = lever_arms(mountings);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = levers.eigenvectors().col(i);
    print_row("rotation     about ({:.2f}, {:.2f}, {:.2f}) shows in the Doppler with lever arms of {:.2f} m\n",
              axis.x(), axis.y(), axis.z(), std::sqrt(std::max(0.0, levers.eigenvalues()[i])));
  }
}

void print_points(const PointsSeen& seen) {
  for (const std::string& warning : seen.warnings) {
    print_row("warning      {}\n", warning);
  }
  if (seen.scans == 0) {
    return;
  }
  print_row("points       {} to {} a scan, median {} ({} scans sampled)\n", seen.sizes.front(), seen.sizes.back(),
            seen.sizes[seen.sizes.size() / 2], seen.scans);
  print_row("invalid      {} NaN/Inf, {} implausible, {} zero-range, {} flagged by the sensor\n",
            seen.dropped.non_finite, seen.dropped.implausible, seen.dropped.zero_range, seen.dropped.flagged);
  if (seen.any()) {
    print_row("range        {:.1f} to {:.1f} m\n", seen.nearest_m, seen.farthest_m);
    print_row("Doppler      {:.1f} to {:.1f} m/s\n", seen.slowest_mps, seen.fastest_mps);
  }
  print_row("point times  {}\n", seen.times ? "yes" : "none");
  if (!seen.columns.empty()) {
    std::string names;
    for (const std::string& name : seen.columns) {
      names += (names.empty() ? "" : ", ") + name;
    }
    print_row("more columns {}\n", names);
  }
}

/// Of the scans, in percent, how many lie between the first and the last pose of the ground truth.
double truth_coverage(const datasets::Dataset& dataset) {
  const formats::Trajectory& truth = dataset.ground_truth();
  std::size_t covered = 0;
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    const Stamp stamp = dataset.stamp(i);
    covered += !truth.empty() && truth.front().stamp <= stamp && stamp <= truth.back().stamp ? 1 : 0;
  }
  return dataset.size() == 0 ? 0.0 : 100.0 * static_cast<double>(covered) / static_cast<double>(dataset.size());
}

void print_diagnosis(const diagnosis::Diagnosis& diagnosis, const datasets::InputSettings& settings) {
  print_row("diagnosis    of {} scans\n", diagnosis.scans_looked_at);
  for (const diagnosis::Finding& finding : diagnosis.findings) {
    print_wrapped(fmt::format("  {:<15} {:<11} {}\n", diagnosis::to_string(finding.question),
                              diagnosis::to_string(finding.verdict), finding.sentence),
                  kSentenceColumn);
    if (const std::string fix = fixing_options(finding, settings); !fix.empty()) {
      print_wrapped(fmt::format("{:<{}}fix with {}\n", "", kSentenceColumn, fix), kSentenceColumn);
    }
    if (finding.question == diagnosis::Question::kPointTimes && finding.verdict == diagnosis::Verdict::kCannotTell) {
      print_wrapped(fmt::format("{:<{}}{}\n", "", kSentenceColumn, sweep_advice(diagnosis.period_s)), kSentenceColumn);
    }
  }
}

Json diagnosis_json(const diagnosis::Diagnosis& diagnosis, const datasets::InputSettings& settings) {
  Json list = Json::array();
  for (const diagnosis::Finding& finding : diagnosis.findings) {
    Json evidence = Json::object();
    for (const auto& [name, value] : finding.evidence) {
      evidence[name] = value;  // what is not finite becomes null
    }
    const std::string fix = fixing_options(finding, settings);
    list.push_back({{"question", diagnosis::to_string(finding.question)},
                    {"verdict", diagnosis::to_string(finding.verdict)},
                    {"sentence", finding.sentence},
                    {"fix", fix.empty() ? Json(nullptr) : Json(fix)},
                    {"evidence", evidence}});
  }
  return list;
}

Json times_json(const TimesSeen& seen) {
  if (seen.periods == 0) {
    return nullptr;
  }
  Json gaps = Json::array();
  for (const auto& [scan, length_s] : seen.gaps) {
    gaps.push_back({{"before_scan", scan}, {"length_s", length_s}});
  }
  return {{"period_s", seen.period_s}, {"shortest_s", seen.shortest_s}, {"longest_s", seen.longest_s}, {"gaps", gaps}};
}

/// Of the scans looked at.
Json points_json(const PointsSeen& seen) {
  Json json = {{"scans_looked_at", seen.scans},
               {"least", seen.sizes.front()},
               {"median", seen.sizes[seen.sizes.size() / 2]},
               {"most", seen.sizes.back()},
               {"not_finite", seen.dropped.non_finite},
               {"implausible", seen.dropped.implausible},
               {"at_the_origin", seen.dropped.zero_range},
               {"flagged", seen.dropped.flagged},
               {"range_m", nullptr},
               {"doppler_mps", nullptr},
               {"times", seen.times}};
  if (seen.any()) {
    json["range_m"] = {seen.nearest_m, seen.farthest_m};
    json["doppler_mps"] = {seen.slowest_mps, seen.fastest_mps};
  }
  return json;
}

void print_json(const InfoOptions& options, const datasets::Dataset& dataset, const TimesSeen& times,
                const PointsSeen& seen, const diagnosis::Diagnosis& diagnosis,
                const std::optional<datasets::BagSummary>& bag) {
  Json json = {{"input", options.input}, {"format", dataset.format()}, {"scans", dataset.size()}};
  if (bag) {
    json["topics"] = topics_json(*bag);
  }
  if (dataset.size() > 0) {
    json["first_timestamp"] = format_seconds(dataset.stamp(0));
    json["last_timestamp"] = format_seconds(dataset.stamp(dataset.size() - 1));
    json["time"] = times_json(times);
    json["points"] = points_json(seen);
    json["points_median"] = seen.sizes[seen.sizes.size() / 2];
    json["point_times"] = seen.times;
  }
  json["columns"] = seen.columns;
  json["sensors"] = Json::array();
  for (const Eigen::Isometry3d& T : seen.mountings) {
    const Eigen::Vector3d t = T.translation();
    json["sensors"].push_back({{"position_m", {t.x(), t.y(), t.z()}}, {"yaw_deg", yaw_deg(T)}});
  }
  json["ground_truth"] = nullptr;
  if (!dataset.ground_truth().empty()) {
    json["ground_truth"] = {{"path", dataset.ground_truth_file().string()},
                            {"poses", dataset.ground_truth().size()},
                            {"coverage_percent", truth_coverage(dataset)}};
  }
  json["diagnosis"] = diagnosis_json(diagnosis, options.settings);
  json["assumptions"] = dataset.assumptions();
  json["warnings"] = seen.warnings;
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// A bag of other messages: its topics are all that there is to say.
void print_without_scans(const InfoOptions& options, const datasets::BagSummary& bag) {
  if (options.json) {
    const Json json = {{"input", options.input},
                       {"format", bag.container},
                       {"scans", 0},
                       {"topics", topics_json(bag)},
                       {"assumptions", bag.notes}};
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  fmt::print("input        {}\n", options.input);
  fmt::print("format       {}\n", bag.container);
  print_topics(bag);
  fmt::print("scans        none: no topic holds clouds of points that are read\n");
  for (const std::string& note : bag.notes) {
    fmt::print("assumed      {}\n", note);
  }
}

/// A calibration has been read as it is: nothing of how recordings are read has an effect on it.
void refuse_input_options(const InfoOptions& options) {
  const auto stated = datasets::texts(options.settings);
  if (!stated.empty()) {
    throw UsageError(fmt::format("{} is what a run learned of its sensor; '{}' is for recordings", options.input,
                                 stated.front().first));
  }
}

int info(const InfoOptions& options) {
  if (options.settings.open.format == "auto" && names_calibration(options.input)) {
    refuse_input_options(options);
    fmt::print("{}", options.json ? calibration_json(options.input) : calibration_info(options.input));
    return 0;
  }
  const std::optional<datasets::BagSummary> bag = bag_of(options.input, options.settings);
  if (bag && !has_clouds(*bag)) {
    print_without_scans(options, *bag);
    return 0;
  }
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(options.input, options.settings);
  const TimesSeen times = look_at_times(*dataset);
  const PointsSeen seen = look_at_points(*dataset);
  const diagnosis::Diagnosis diagnosis =
      diagnosis::diagnose(*dataset, {.applied = options.settings.correction}, Workers());
  if (options.json) {
    print_json(options, *dataset, times, seen, diagnosis, bag);
    return 0;
  }
  print_row("input        {}\n", options.input);
  print_row("format       {}\n", dataset->format());
  if (bag) {
    print_topics(*bag);
  }
  print_row("scans        {}\n", dataset->size());
  print_time(*dataset, times);
  print_points(seen);
  print_rig(seen.mountings);
  if (dataset->ground_truth().empty()) {
    print_row("ground truth none\n");
  } else {
    print_row("ground truth {} ({} poses, {:.0f} % of the scans)\n", dataset->ground_truth_file().string(),
              dataset->ground_truth().size(), truth_coverage(*dataset));
  }
  print_diagnosis(diagnosis, options.settings);
  for (const std::string& assumption : dataset->assumptions()) {
    print_row("assumed      {}\n", assumption);
  }
  if (dataset->size() == 1) {
    print_row("hint         {}\n", kOneScan);
  }
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand(
      "info",
      "What the program sees in a recording: layout, scans, times, ranges, and what is wrong with its numbers. Of a "
      "run: what it learned of the error of its sensor's Doppler, as numbers and as a picture");
  command
      ->add_option("INPUT", options->input,
                   "Folder of the recording; or folder of a run with --preset default, or its calibration.yaml")
      ->required();
  add_input_options(*command, options->settings);
  command->add_flag("--json", options->json, "Print it as JSON, with the numbers that the answers rest on");
  command->callback([options, &selected] { selected = [options] { return info(*options); }; });
}

}  // namespace dynamic_icp::apps
