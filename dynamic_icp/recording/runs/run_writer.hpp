// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/run_summary.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// Writes the files of a run while it continues: trajectory.tum, frames.jsonl, objects.jsonl, labels/*.bin (if asked
/// for), summary.json; all but run.json. It takes no more memory for more scans until `finish`: what is needed of each
/// lies in kScanRecordsFile, which the caller removes with the checkpoint. The folder exists already; see
/// formats/output_folder for how a run appears whole or not at all. Throws DataError naming the file that could not be
/// written.
class RunWriter {
 public:
  RunWriter(const std::filesystem::path& folder, bool save_labels);

  /// Goes on with the files in the folder where another one was when it wrote `state`; `next` is the scan after those
  /// in it. What was written later is cut off or removed. Throws DataError when something of the files is missing or
  /// not what it was.
  RunWriter(const std::filesystem::path& folder, bool save_labels, std::size_t next, StateArchive& state);

  void add(std::size_t index, const odometry::Frame& frame);

  /// One pose for each scan, after `finish`.
  [[nodiscard]] const formats::Trajectory& trajectory() const { return trajectory_; }

  /// For another one to resume; what is written so far is on the device after it.
  void save(StateArchive& archive);

  /// Writes what is left. `ground_truth` may be empty, and may not fit: then there is no accuracy, and the summary says
  /// why. `stopped`: before the last scan, because someone asked to.
  RunSummary finish(const std::string& method, const formats::Trajectory& ground_truth,
                    const std::vector<std::string>& assumptions, bool stopped = false);

 private:
  /// What there is of the run: bytes of the files and scans.
  struct Written {
    std::uint64_t frames = 0;
    std::uint64_t objects = 0;
    std::size_t scans = 0;
  };
  RunWriter(const std::filesystem::path& folder, bool save_labels, const Written& written);
  static Written written_in(StateArchive& archive);
  void check_records() const;
  void check_labels(std::size_t next) const;

  std::filesystem::path folder_;
  bool save_labels_;
  formats::OutputFile frames_file_;
  formats::OutputFile objects_file_;
  formats::OutputFile records_file_;
  std::size_t scans_ = 0;
  formats::Trajectory trajectory_;
};

}  // namespace dynamic_icp::runs
