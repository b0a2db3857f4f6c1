// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/tools/results/map_writer.hpp"
#include "dynamic_icp/tools/results/run_writer.hpp"

#include "apps/method_options.hpp"
#include "apps/recording_check.hpp"

namespace dynamic_icp::apps {

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

/// What was found and done about the time that scans take: as in the first usable scan, and whether the others agree.
struct SweepRecord {
  std::optional<motion::SweepReport> first;
  bool same_times = true;
  bool all_undone = true;

  void add(const odometry::Frame& frame, const RawScan& scan);
  [[nodiscard]] bool undone() const { return first && all_undone; }
  [[nodiscard]] std::string times() const;
  [[nodiscard]] std::optional<double> duration_s() const { return first ? first->duration_s : std::nullopt; }
};

/// The warnings of a run: all are kept, the first few are told at once.
struct Warnings {
  std::vector<std::string> texts;
  bool quiet = false;

  void add(const std::string& text);
};

/// What a run found and made beside the files of every run.
struct Findings {
  Warnings warnings;
  RecordingCheck recording;
  std::vector<std::string> assumptions;
  SweepRecord sweep;
  std::optional<results::MapWriter> map;
  bool reported = false;              ///< report.html is there
  std::vector<std::string> failures;  ///< what was asked for beside the run itself and could not be made, and why

  void fail(const std::string& text) {
    failures.push_back(text);
    warnings.texts.push_back(text);  // told at the end
  }
};

/// The content of run.json. `map_in_run`: the map's name in the folder of the run, empty where it lies elsewhere.
std::string run_json(const RunOptions& options, const datasets::Dataset& dataset, const odometry::Config& config,
                     const std::filesystem::path& ground_truth, const Findings& findings,
                     const std::filesystem::path& map_in_run);

/// What the user is told at the end.
void print_summary(const results::RunSummary& summary, const Findings& findings, const RunOptions& options);

}  // namespace dynamic_icp::apps
