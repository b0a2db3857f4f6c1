// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/tools/benchmark/content_checksum.hpp"

namespace dynamic_icp::benchmark {

/// A recording that takes part, with what tells whether it is still the same.
struct Sequence {
  std::string label;           ///< name of its folder, unique in a benchmark
  std::filesystem::path path;  ///< absolute
  std::size_t scans = 0;
  Stamp first_stamp;
  Stamp last_stamp;
  std::string content;                 ///< checksum of all that is read of it
  std::filesystem::path object_truth;  ///< objects.jsonl of a simulated recording; empty without
  std::uintmax_t bytes = 0;            ///< of all that is read of it
};

/// A folder that takes no part.
struct Skipped {
  std::string reason;                         ///< begins with its name
  datasets::UnclearInput::Settings proposal;  ///< with which it may be read; empty: none is known
};

struct Sequences {
  std::vector<Sequence> sequences;  ///< in the order of the inputs
  std::vector<Skipped> skipped;     ///< folders beside recordings that are none
};

/// Throws DataError that lists what was skipped, UnclearInput with the first proposal where there is one.
[[noreturn]] void refuse_all(const std::string& what, const std::vector<Skipped>& skipped);

/// Opens one recording, without a label. Throws as `open_input` does, and DataError when it holds no scans.
Sequence open_sequence(const std::filesystem::path& path, const datasets::InputSettings& settings,
                       const std::filesystem::path& output);

/// Opens the inputs. A folder that is no recording but whose direct sub-folders are counts as all of these, sorted by
/// name; a recording that is damaged is none of that, but an error. Two recordings of the same name get the name of
/// their folder in front, or a number behind. Files in `output` do not count as part of a recording. Throws DataError
/// for an input that is no recording and holds none, UnclearInput where those it holds could be read; UsageError when a
/// recording is given twice.
Sequences open_sequences(const std::vector<std::string>& inputs, const datasets::InputSettings& settings,
                         const std::filesystem::path& output);

}  // namespace dynamic_icp::benchmark
