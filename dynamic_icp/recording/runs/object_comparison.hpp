// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

namespace dynamic_icp::runs {

/// The moving bodies of a run against those of the simulated recording: `run` and `recording` are their folders, or the
/// objects.jsonl in them. Beyond `compare_tracks`:
///
///   predictions   by the ground truth of the recording;
///   held points   by the points and the labels/ of the recording, and its motion.csv where scans take time;
///   map ghosts    by the labels/ of both, over all scans of the run that have labels.
///
/// Each stays empty where what it takes is not there; points are read only of scans with labels and pairs. Throws
/// DataError naming the file and the place when one of the objects.jsonl is missing or any file is damaged.
evaluation::ObjectTracking compare_run_objects(const std::filesystem::path& run,
                                               const std::filesystem::path& recording);

}  // namespace dynamic_icp::runs
