// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "dynamic_icp/method/base/raw_scan.hpp"

namespace dynamic_icp::runs {

/// The file in the folder of a run from which the run can be resumed.
inline constexpr const char* kCheckpointFile = "checkpoint";

/// JSON of runs is nested no deeper.
inline constexpr int kMaxDepthOfSettings = 16;

/// A run between two scans.
struct Checkpoint {
  std::string identity;         ///< JSON of what must be the same when it is resumed (run_identity)
  std::string command;          ///< how the run was asked for at first
  std::size_t next = 0;         ///< the first scan that is not done, its index in the recording
  std::uint64_t last_scan = 0;  ///< checksum of the scan before it
  std::string odometry;         ///< Odometry::save
  std::string results;          ///< of what was written and counted, StateArchive
};

/// A number that tells scans from each other, from all their columns.
std::uint64_t checksum(const RawScan& scan);

/// Puts the checkpoint into the place of the one before, whole or not at all, and waits until it is on the device.
void write_checkpoint(const std::filesystem::path& folder, Checkpoint& checkpoint);

/// Throws DataError naming the file when it is damaged.
Checkpoint read_checkpoint(const std::filesystem::path& folder);

/// The first setting in which two runs differ, in words: "method was \"kiss-icp\" and is \"gicp\" now". Nothing where
/// they agree. What only one of them tells (run.json knows less) is no difference.
std::optional<std::string> difference(const std::string& identity_then, const std::string& identity_now);

/// When it is time for a checkpoint: so that what is lost when a run ends early is about `interval_s` of computation,
/// and writing takes a hundredth of the time at most.
class CheckpointTimer {
 public:
  /// With 0 s it is always time.
  explicit CheckpointTimer(double interval_s) : interval_s_(interval_s) {}

  [[nodiscard]] bool is_due() const;

  /// Calls what writes the checkpoint.
  template <class Write>
  void time(const Write& write) {
    const auto begin = Clock::now();
    write();
    last_ = Clock::now();
    cost_ = last_ - begin;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double interval_s_;
  Clock::time_point last_ = Clock::now();
  Clock::duration cost_{};
};

}  // namespace dynamic_icp::runs
