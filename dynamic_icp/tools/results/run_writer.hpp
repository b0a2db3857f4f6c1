// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/evaluation/run_accuracy.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::results {

/// What summary.json says of a run. Ratios and times are over the frames they exist for; empty where there is none.
struct RunSummary {
  std::string method;
  std::size_t frames = 0;
  evaluation::RunAccuracy accuracy;        ///< empty numbers without ground truth
  std::optional<double> mean_iterations;   ///< over aligned pairs
  std::optional<double> convergence_rate;  ///< converged pairs over all pairs
  std::optional<double> ms_mean;
  std::optional<double> ms_median;
  std::optional<double> ms_p95;
  std::optional<double> fps;                 ///< 1000 / ms_mean
  std::optional<double> dynamic_ratio_mean;  ///< dynamic candidates over points used
  std::optional<double> dynamic_ratio_max;
  std::optional<double> clustered_ratio_mean;  ///< clustered over dynamic candidates
  std::optional<double> refined_ratio_mean;    ///< in an accepted object over clustered, as the paper tabulates it
  std::vector<std::string> assumptions;        ///< what had to be taken for granted about recording and method
  std::vector<std::pair<std::string, std::size_t>> status_counts;  ///< frames per status, as they first occurred
};

/// Writes the files of a run while it goes on, in bounded memory: trajectory.tum, frames.jsonl, objects.jsonl,
/// labels/*.bin (if asked for), summary.json, run.json. The folder exists already; see formats/output_folder for how a
/// run appears whole or not at all. Throws DataError naming the file that could not be written.
class RunWriter {
 public:
  RunWriter(const std::filesystem::path& folder, bool save_labels);

  void add(std::size_t index, const odometry::Frame& frame);

  /// Writes what is left. `ground_truth` may be empty. `run_json` is the content of run.json.
  RunSummary finish(const std::string& method, const formats::Trajectory& ground_truth,
                    const std::vector<std::string>& assumptions, const std::string& run_json);

 private:
  std::filesystem::path folder_;
  bool save_labels_;
  formats::OutputFile frames_file_;
  formats::OutputFile objects_file_;
  formats::Trajectory trajectory_;
  std::vector<double> total_ms_;
  std::vector<double> iterations_;
  std::vector<double> dynamic_ratio_;
  std::vector<double> clustered_ratio_;
  std::vector<double> refined_ratio_;
  std::size_t pairs_ = 0;
  std::size_t converged_ = 0;
  std::vector<std::pair<std::string, std::size_t>> status_counts_;
};

/// The summary as summary.json holds it.
std::string summary_json(const RunSummary& summary);

}  // namespace dynamic_icp::results
