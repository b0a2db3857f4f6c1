// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::odometry {

/// The scans of a stream in their order: which of them can be aligned, and the times between them.
class ScanStream {
 public:
  /// Scans less than `min_interval_s` apart are too soon.
  explicit ScanStream(const StreamConfig& config, double min_interval_s = kMinScanInterval_s)
      : config_(config), min_interval_s_(min_interval_s) {}

  /// Throws DataError when a scan with this stamp would not be later than the last one.
  void check_order(Stamp stamp) const;

  /// Takes in the next scan with so many usable points. Says why it cannot be aligned to the last usable one: kFirst
  /// when there is none, kTooFewPoints, kTooSoon or kTimeGap. kNotRun: it can be.
  FrameStatus add(Stamp stamp, std::size_t points);

  /// Of the scan added last: after the first usable scan, after the last usable one before it, and after the last one
  /// of any kind; 0 where there was none.
  [[nodiscard]] double elapsed_s() const { return elapsed_s_; }
  [[nodiscard]] double interval_s() const { return interval_s_; }
  [[nodiscard]] double since_any_s() const { return since_any_s_; }

  /// Whether there was a usable scan, and when the last one was, after the first one.
  [[nodiscard]] bool has_begun() const { return last_usable_.has_value(); }
  [[nodiscard]] double last_usable_s() const;
  /// Whether a scan was seen at this time or later.
  [[nodiscard]] bool is_past(Stamp stamp) const { return last_ && stamp <= *last_; }

  /// The interval, but no longer than a motion is predicted ahead.
  [[nodiscard]] double prediction_time_s() const;

  void state(StateArchive& archive);

 private:
  [[nodiscard]] FrameStatus obstacle(std::size_t points) const;

  StreamConfig config_;
  double min_interval_s_;
  std::optional<Stamp> first_usable_;
  std::optional<Stamp> last_usable_;
  std::optional<Stamp> last_;
  double elapsed_s_ = 0.0;
  double interval_s_ = 0.0;
  double since_any_s_ = 0.0;
};

/// Whether a scan with this obstacle takes no part: the reference and the state stay those of the previous scan.
bool is_skipped(FrameStatus obstacle);

}  // namespace dynamic_icp::odometry
