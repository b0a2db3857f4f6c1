// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/runs/latency.hpp"
#include "dynamic_icp/recording/runs/live_view_settings.hpp"
#include "dynamic_icp/recording/runs/recording_check.hpp"
#include "dynamic_icp/recording/runs/run_summary.hpp"
#include "dynamic_icp/recording/runs/sweep_record.hpp"

namespace dynamic_icp::runs {

/// A recording, and what the user says about it.
struct Recording {
  std::filesystem::path path;
  datasets::InputSettings settings;
};

struct RunSettings {
  std::filesystem::path output;  ///< folder of the run: new or empty, or an earlier run where `replace` is set
  bool replace = false;
  bool resume = false;  ///< resumes an earlier run in `output` that was ended; with none it begins one
  double checkpoint_s =
      10.0;  ///< of computation between two checkpoints, from which a run can be resumed; 0: every scan
  std::string method = "dynamic-icp";
  std::string preset = "default";  ///< for run.json: what it means is in `config`
  std::string ablation = "none";   ///< likewise
  odometry::Config config;
  int threads = 0;                        ///< 0: as many as the machine has; results do not depend on it
  std::size_t start = 0;                  ///< first scan, counted from 0
  std::optional<std::size_t> max_frames;  ///< most scans to process; all where empty
  std::filesystem::path ground_truth;     ///< file to compare with; empty: what the recording brings along
  bool save_labels = false;
  std::optional<std::filesystem::path> map_file;  ///< static points of all scans, .ply or .pcd; dynamic-icp only
  double map_voxel_m = 0.1;
  std::optional<std::filesystem::path> mcap_file;    ///< scans and results for Foxglove, .mcap (mcap_recorder.hpp)
  std::optional<LiveViewSettings> live;              ///< who may watch the run, and where (live_view.hpp)
  std::optional<std::filesystem::path> kitti_file;   ///< poses as KITTI has them, .txt
  std::optional<std::filesystem::path> calibration;  ///< calibration.yaml of another run with this sensor
  std::vector<std::filesystem::path> inputs;         ///< further files that were read and must not be replaced
  bool follow = false;  ///< the recording grows: scans are taken as they come (datasets/followed_dataset.hpp)
  std::optional<double> follow_timeout_s;  ///< without a scan after which it has ended; empty: none
  std::string command;                     ///< how the run was asked for, for run.json
};

/// What the caller of a run may want to hear and do while it continues. All are called by the calling thread; each may
/// be empty.
struct RunCallbacks {
  /// Before the first scan and after each one; a resumed run begins with the scans that are done. `total` is 0
  /// where nobody knows: of a recording that grows.
  std::function<void(std::size_t done, std::size_t total)> progress;
  /// What the user should know, as soon as it is known.
  std::function<void(const std::string& text)> warning;
  /// How the run goes, which is no part of its results: that it is resumed, that there is no checkpoint.
  std::function<void(const std::string& text)> notice;
  /// Where the run can be watched from now on: "127.0.0.1:8765".
  std::function<void(const std::string& authority)> listening;
  /// After each scan with what was found of it, `index` in the recording; files of the run have it already.
  std::function<void(std::size_t index, const odometry::Frame& frame)> frame;
  /// See check_recording: how messages word the corrections of what the diagnosis finds.
  FixInWords fix_in_words;
  /// Asked before each scan whether the run is to be given up.
  std::function<bool()> cancelled;
  /// Asked after each scan but the last whether the run is to end there, with the results so far; of a recording that
  /// grows also while it is waited for, and before the first scan, where the run ends without results.
  std::function<bool()> stop;
  /// Adds files to a run whose own files are written, before its folder appears. What it throws is one of the run's
  /// failures.
  std::function<void(const std::filesystem::path& folder)> add_files;
};

/// What came of a run beside its files.
struct RunResult {
  bool was_complete = false;  ///< a run to be resumed: nothing was left to do, and what follows is empty
  RunSummary summary;
  std::size_t scans_selected = 0;  ///< more than the summary has where the run was stopped
  Latency latency;
  double period_s = 0.0;  ///< from scan to scan, median; 0 of one scan
  std::string doppler;    ///< kind and sign, in words
  SweepRecord sweep;
  std::vector<std::string> warnings;
  std::optional<std::size_t> map_points;  ///< empty without a map
  bool has_mcap = false;                  ///< whether the file that was asked for is there
  bool has_kitti = false;                 ///< likewise
  std::vector<std::string> failures;      ///< what was asked for beside the run and could not be made, and why
};

/// Odometry over a recording: opens it, diagnoses some scans of it, processes all that are selected, and writes the
/// files of a run (run_writer.hpp) with run.json and the map into a folder that appears whole or not at all. Nothing
/// when it was cancelled: then nothing is written, and an earlier run in the folder stays as it was.
///
/// A run that ends otherwise, by a signal or an error too, can be resumed from its last checkpoint (checkpoint.hpp) and
/// then ends with the bytes of an unbroken one, but for times of computation. That needs the same recording and
/// settings; others are a DataError that names the difference. Runs that follow a recording or write an MCAP file
/// cannot.
///
/// Throws UsageError when the settings cannot be meant, DataError when the recording cannot be read, is wrong beyond
/// doubt (check_recording) or has no scan with enough points, when the ground truth of the settings fits no scan, or
/// when the machine fails. A run in which most scans are lost is written all the same: see RunSummary::failure.
std::optional<RunResult> run_recording(const Recording& recording, const RunSettings& settings,
                                       const RunCallbacks& callbacks = {});

}  // namespace dynamic_icp::runs
