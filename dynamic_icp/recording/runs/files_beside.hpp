// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/runs/map_writer.hpp"
#include "dynamic_icp/recording/runs/mcap_recorder.hpp"
#include "dynamic_icp/recording/runs/run_json.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// What is asked for beside the results of a run and may lie anywhere: its map, an MCAP file, poses as KITTI has them.
/// What cannot be made of it is no reason to lose the run, and is told.
class FilesBeside {
 public:
  using Fail = std::function<void(const std::string& text)>;

  /// The settings must outlive it. `fail` is told what could not be made, and why. Throws UsageError when a file cannot
  /// be meant.
  FilesBeside(const RunSettings& settings, Fail fail);

  /// What a run reads is not written over: throws UsageError where one of the files is among its inputs.
  void refuse(const std::vector<std::filesystem::path>& inputs) const;

  /// Files in the folder of the run go to where that is put together. Throws as `map_destination` does.
  void place(const formats::OutputFolder& output);
  [[nodiscard]] FilesInRun in_run(const formats::OutputFolder& output) const;

  /// Begins the MCAP file, if one is asked for. A path that cannot be written to is a DataError.
  void open(const formats::Trajectory& ground_truth, const RunMessagesSettings& messages);

  void add(const RawScan& scan, const odometry::Frame& frame, double latency_ms);

  /// What there is, or will be unless writing it fails.
  void describe(RunResult& result) const;

  /// Last, for an earlier file is only replaced by that of a run that is whole.
  void write(const formats::Trajectory& trajectory, const formats::OutputFolder& output, RunResult& result);

  /// Of the map, scan by scan: an MCAP file cannot be resumed.
  void state(StateArchive& archive);
  void begin_anew();

 private:
  void add_to_map(const odometry::Frame& frame);
  void record(const RawScan& scan, const odometry::Frame& frame, double latency_ms);
  void write_map(const formats::OutputFolder& output, RunResult& result);
  void write_mcap(const formats::OutputFolder& output, RunResult& result);
  void write_kitti(const formats::Trajectory& trajectory, const formats::OutputFolder& output, RunResult& result);

  const RunSettings& settings_;
  Fail fail_;
  std::optional<MapWriter> map_;
  std::optional<McapRecorder> recorder_;
  std::filesystem::path map_file_;
  std::filesystem::path mcap_file_;
  std::filesystem::path kitti_file_;
};

}  // namespace dynamic_icp::runs
