// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"

namespace dynamic_icp::datasets {

/// When something was there, by the clock of the machine.
using Arrival = std::chrono::system_clock::time_point;

/// A recording that still grows. `size` is how many of its scans are known to be there. One thread at a time.
class FollowedDataset : public Dataset {
 public:
  /// Waits until scan `index` is there, as long as it takes. False where none will come: the recording was closed, or
  /// `stop`, which is asked many times a second, said so. Throws DataError where the recording is damaged or changes
  /// behind what was read of it.
  virtual bool wait_for(std::size_t index, const std::function<bool()>& stop) = 0;

  /// When the last byte of a scan came; nothing where it was there before it was followed.
  [[nodiscard]] virtual std::optional<Arrival> arrival(std::size_t index) const = 0;
};

/// Opens a recording that grows, once `scans` of its scans are there or no more will come: a folder of files, one for
/// each scan, whose names are in the order of time. Nothing where `stop` said so before.
///
/// Throws as `open_input` does where that does not go away while one waits; a folder without scans may get some.
std::unique_ptr<FollowedDataset> follow_input(const std::filesystem::path& input, const InputSettings& settings,
                                              std::size_t scans, const std::function<bool()>& stop);

}  // namespace dynamic_icp::datasets
