// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/formats/result_kind.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"
#include "dynamic_icp/recording/runs/frame_rows.hpp"
#include "dynamic_icp/recording/runs/run_values.hpp"

namespace dynamic_icp::runs {

/// What a run left behind.
struct RunFiles {
  std::filesystem::path folder;
  formats::Trajectory trajectory;  ///< one pose per frame
  std::vector<FrameRow> frames;
  std::vector<std::vector<ObjectRow>> objects;  ///< one list per frame
  Settings summary;                             ///< summary.json
  Settings run;                                 ///< run.json without configuration and warnings
  Settings configuration;                       ///< "configuration" of run.json
  std::vector<std::string> warnings;            ///< "assumptions" and "warnings" of run.json

  /// When a frame was taken, in seconds after the first one.
  [[nodiscard]] double seconds(std::size_t frame) const;
};

/// Whether a folder holds a run, of which not all need be there.
bool is_run_folder(const std::filesystem::path& folder);

/// Reads the folder of a finished run. Throws DataError naming the file, the line and what was expected when a file is
/// missing, a line is no complete JSON object, a key is missing or of the wrong kind, or the files disagree about how
/// many scans there are.
RunFiles read_run(const std::filesystem::path& folder);

/// Whether the run wrote labels (`--save-labels`) but not, or no more, those of this frame.
bool lacks_labels(const RunFiles& run, std::size_t frame);

/// labels/*.bin of a frame (with `--save-labels`): per point of the scan as read -1 not used, 0 static, > 0 the
/// id of its object. Empty optional when there is no such file; DataError when its length is not `points`.
std::optional<std::vector<std::int32_t>> read_labels(const RunFiles& run, std::size_t frame, std::size_t points);

/// The same of scan `index` of the recording, in the folder of a run or of a simulated recording, where > 0 is the id
/// of a moving body. DataError when the file holds no whole numbers, or other than `points` where this is given.
std::optional<std::vector<std::int32_t>> read_labels(const std::filesystem::path& folder, std::size_t index,
                                                     std::optional<std::size_t> points = {});

/// Where a run, or a simulated recording, keeps the labels of scan `index` of the recording.
std::filesystem::path labels_file(const std::filesystem::path& folder, std::size_t index);

/// The files that the folder of a run may hold, its pictures and its report among them.
formats::ResultKind run_result();

}  // namespace dynamic_icp::runs
