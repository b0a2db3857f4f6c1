// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/scan_view.hpp"

namespace dynamic_icp::figures {

/// Errors over stretches of one length: root mean squares over all that begin at a frame.
struct StretchError {
  double length_m = 0.0;  ///< along the ground truth
  std::size_t count = 0;
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};

/// The ground truth of a run at the times of its frames.
struct RunTruth {
  /// T_world_sensor per frame, moved so that the first matched pose is the estimated one; empty where unknown.
  std::vector<std::optional<Eigen::Isometry3d>> poses;
  std::vector<double> speed;              ///< m/s, per frame; NaN where unknown
  std::vector<double> translation_error;  ///< m, of the motion from the frame before, per frame; NaN where unknown
  std::vector<double> rotation_error;     ///< degrees, the same
  std::vector<double> nees_rotation;      ///< of that motion, 3 is right; NaN where unknown or no covariance is stated
  std::vector<double> nees_translation;   ///< the same
  std::vector<StretchError> stretches = {};  ///< 1, 2, 5, 10, ... m, as far as the ground truth goes
};

/// What figures show beyond the files of the run, read again from the recording and its ground truth.
struct RunContext {
  std::optional<RunTruth> truth;   ///< empty without ground truth
  std::optional<ScanView> scan;    ///< empty when the recording is gone
  std::vector<std::string> notes;  ///< what had to be left out and why, in sentences
};

/// Reads what it can; what is gone or broken is left out and stands in the notes. `frame` is the line of frames.jsonl,
/// counted from 0, to show as a scan; without it the one with most points on objects. Throws UsageError when the run
/// has no such frame.
RunContext read_context(const runs::RunFiles& run, std::optional<std::size_t> frame = std::nullopt);

/// The recording of the run, opened as the run opened it; null, with a note why, when that cannot be.
std::unique_ptr<datasets::Dataset> open_recording(const runs::RunFiles& run, std::vector<std::string>& notes);

/// The ground truth of the run; empty, with a note why, when there is none that can be used. `recording` may be null.
std::optional<RunTruth> read_truth(const runs::RunFiles& run, const datasets::Dataset* recording,
                                   std::vector<std::string>& notes);

/// The scan of a frame. Throws DataError when the recording is not the one that the run saw.
RawScan read_scan(const runs::RunFiles& run, const datasets::Dataset& recording, std::size_t frame);

/// The line of frames.jsonl with the most points on objects, the first of several; 0 when there are no objects.
std::size_t frame_with_most_object_points(const runs::RunFiles& run);

}  // namespace dynamic_icp::figures
