// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/tools/benchmark/sequences.hpp"

namespace dynamic_icp::benchmark {

/// A recording that a manifest asks for.
struct ManifestEntry {
  std::string name;                  ///< its label in the tables
  std::vector<std::string> folders;  ///< ends of its path, the parts with slashes between; any of them will do
};

/// Which recordings of a data set a benchmark is made of, for those who have the data:
///
///   description: one sentence
///   format: hercules
///   lidars: [front_wide_lidar]          # optional
///   sequences:
///     - name: bridge-01
///       folders: [Bridge/01_Day]
struct Manifest {
  std::string description;
  std::string format;
  std::vector<std::string> lidars;
  std::vector<ManifestEntry> sequences;
};

/// Throws DataError and UsageError as YamlMap does, also for a name that stands twice or cannot be that of a
/// folder beside the files of a benchmark.
Manifest read_manifest(const std::filesystem::path& path);

/// Takes over format and sensors.
void apply(const Manifest& manifest, datasets::InputSettings& settings);

/// Finds the recordings in folders at most five levels below `root`, where the parts of a path are compared without
/// regard to upper case, blanks, '-' and '_', and opens them with `settings`. Those that are not there, or cannot be
/// opened, are among the skipped ones. Throws DataError when there is none at all.
Sequences open_manifest(const Manifest& manifest, const std::filesystem::path& root,
                        const datasets::InputSettings& settings, const std::filesystem::path& output);

}  // namespace dynamic_icp::benchmark
