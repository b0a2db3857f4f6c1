// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/followed_dataset.hpp"

namespace dynamic_icp::datasets {

/// Hands out the scans [begin, end) of a recording in their order and reads the one after in the meantime, on a thread
/// of its own. At most two scans are in memory. The recording must outlive it, and nobody else may read from it.
class ReadAhead {
 public:
  ReadAhead(const Dataset& dataset, std::size_t begin, std::size_t end);

  /// Of a recording that grows, which is waited for.
  ReadAhead(FollowedDataset& dataset, std::size_t begin, std::size_t end);

  /// Gives up waiting for a recording that grows.
  ~ReadAhead() { stop(); }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Whether no scan is left. Of a recording that grows that is known once the next one is there, or the end is:
  /// waits for it.
  [[nodiscard]] bool done() const;

  /// Waits for the next scan, or for it being known that there is none, but not longer than that. False: nothing is
  /// known yet.
  [[nodiscard]] bool wait(std::chrono::milliseconds longest) const;

  /// The next scan. Waits for it where the computation is faster than the disk; throws what `Dataset::scan` throws.
  RawScan next();

  /// When the scan that was handed out last was there (FollowedDataset::arrival).
  [[nodiscard]] std::optional<Arrival> arrival() const { return arrival_; }

  /// What was noticed of a recording that grows while that scan was waited for (FollowedDataset::take_notes).
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// No more scans of a recording that grows are waited for.
  void stop() { is_stopped_ = true; }

 private:
  struct Read {
    RawScan scan;
    std::optional<Arrival> arrival;
    std::vector<std::string> notes;
  };

  void start_reading();
  [[nodiscard]] Read read(std::size_t index);

  const Dataset& dataset_;
  FollowedDataset* followed_ = nullptr;
  std::size_t next_;
  std::size_t end_;
  std::atomic<bool> is_stopped_ = false;
  std::atomic<bool> is_at_end_ = false;  ///< of a recording that grew
  std::optional<Arrival> arrival_;
  std::vector<std::string> notes_;
  std::future<Read> reading_;  // the first to go: it uses the others
};

}  // namespace dynamic_icp::datasets
