// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"
#include "dynamic_icp/tools/benchmark/sequences.hpp"

namespace dynamic_icp::benchmark {

/// What all runs of a benchmark have in common, as the command `run` takes it.
struct RunSettings {
  std::string preset = "default";
  std::string config_file;  ///< of all methods, empty: none; runs get `settings` alone
  std::vector<std::string> settings;
  datasets::InputSettings input;  ///< what was said about the recordings
  std::size_t start = 0;
  std::optional<std::size_t> max_frames;
  int threads = 0;
};

/// What runs the cells.
struct Program {
  std::filesystem::path path;
  std::string version;
  std::string checksum;   ///< of its file: two builds of one version may differ
  std::string processor;  ///< of the machine
};

/// A cell that is to be there in the end.
struct CellPlan {
  CellKey key;
  std::filesystem::path folder;        ///< relative to the benchmark's: <sequence>/<method> or <method>_<ablation>
  std::vector<std::string> arguments;  ///< of the program, without the output
  std::string fingerprint;             ///< equal for two runs that give the same result
  std::filesystem::path object_truth;  ///< empty without
  std::size_t scans = 0;               ///< that the run will process
  std::uintmax_t bytes_per_scan = 0;   ///< mean size in the recording
};

/// `configuration` is what the run will use, resolved: "key=value" for all keys.
///
/// The fingerprint is a JSON text of everything that decides the result: program, method, preset, ablation, resolved
/// configuration, range of scans, and the path and content of the recording. Threads and processor are part of it
/// because times depend on them. The number of runs at the same time is not: it is recorded with each result instead.
CellPlan plan_cell(const Program& program, const Sequence& sequence, const std::string& method,
                   const std::string& ablation, const RunSettings& settings,
                   const std::vector<std::string>& configuration);

}  // namespace dynamic_icp::benchmark
