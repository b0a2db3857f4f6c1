// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"

namespace dynamic_icp::datasets {

/// When something was there, by a clock that never jumps.
using Arrival = std::chrono::steady_clock::time_point;

/// A recording that still grows. `size` is how many of its scans are known to be there. One thread at a time.
class FollowedDataset : public Dataset {
 public:
  /// Waits until scan `index` is there, as long as it takes. False where none will come: the recording was closed, or
  /// `stop`, which is asked many times a second, said so. Throws DataError where the recording is damaged or changes
  /// behind what was read of it.
  virtual bool wait_for(std::size_t index, const std::function<bool()>& stop) = 0;

  /// When the last byte of a scan came; nothing where it was there before it was followed.
  [[nodiscard]] virtual std::optional<Arrival> arrival(std::size_t index) const = 0;

  /// Scans before that one are not asked for again, and need not be kept.
  virtual void release_before(std::size_t /*index*/) {}

  /// What was noticed since it was asked last, such as where the recording was cut short: sentences for the user.
  virtual std::vector<std::string> take_notes() { return {}; }

  /// No more is waited for: the ground truth becomes that of all that has come, where the recording has some.
  virtual void finish() {}
};

/// What stands for standard input where a recording is named.
constexpr const char* kStandardInput = "-";

/// Which scans are to be there before a recording that grows is worked with, and how long to wait for each.
struct FirstScans {
  std::size_t begin = 0;
  std::size_t count = 1;
  std::optional<std::chrono::duration<double>> longest_silence = {};  ///< nothing: without end
};

/// Opens a recording that grows, once some of its scans are there or no more will come: a folder of files, one for
/// each scan, whose names are in the order of time; an MCAP file that another program writes; or, by the name "-", an
/// MCAP file that comes through standard input. Nothing where `stop` said so before.
///
/// Throws as `open_input` does where that does not go away while one waits; a folder or file without scans may get
/// some. Throws UsageError for what cannot be followed: other bags.
std::unique_ptr<FollowedDataset> follow_input(const std::filesystem::path& input, const InputSettings& settings,
                                              const FirstScans& first, const std::function<bool()>& stop);

}  // namespace dynamic_icp::datasets
