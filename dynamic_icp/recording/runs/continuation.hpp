// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"

namespace dynamic_icp::runs {

/// What is left to do of a run that is to be resumed.
struct Continuation {
  bool is_complete = false;        ///< nothing: an earlier run in the folder is whole
  std::optional<Checkpoint> from;  ///< where it resumes; empty: begins anew
};

/// Looks for the checkpoint of a run that was killed, taken over in `output`, or of one that was stopped, in `final`:
/// its files are copied into the staging folder then. What a run may have written after its last checkpoint is
/// removed. A damaged checkpoint is told by `notice`, and the run begins anew.
///
/// Throws DataError naming the setting where the earlier run is another one than that of `identity` (run_identity); one
/// that is whole may be replaced with `replace`. So it does where something of what is left belongs to another user, or
/// is a link or a pipe.
Continuation continuation(const formats::OutputFolder& output, const std::filesystem::path& final,
                          const std::string& identity, bool replace,
                          const std::function<void(const std::string& text)>& notice);

/// Throws DataError naming the run in `final` where it cannot go on from a checkpoint with the `scans` of a recording:
/// they end before it or begin behind it, or the last one that was done is not what it was.
void refuse_other_scans(const Checkpoint& from, const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                        const std::filesystem::path& final);

/// Removes what a run wrote scan by scan into its staging folder.
void remove_files_of_run(const std::filesystem::path& staging);

}  // namespace dynamic_icp::runs
