// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/scan_stream.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::odometry {
namespace {

double seconds_since(const std::optional<Stamp>& from, Stamp to) { return from ? seconds_between(*from, to) : 0.0; }

}  // namespace

void ScanStream::check_order(Stamp stamp) const {
  if (last_ && stamp <= *last_) {
    throw DataError(fmt::format("the scan at {} s is not later than the one before, at {} s", format_seconds(stamp),
                                format_seconds(*last_)));
  }
}

FrameStatus ScanStream::add(Stamp stamp, std::size_t points) {
  elapsed_s_ = seconds_since(first_usable_, stamp);
  interval_s_ = seconds_since(last_usable_, stamp);
  since_any_s_ = seconds_since(last_, stamp);
  const FrameStatus found = obstacle(points);
  last_ = stamp;
  if (!is_skipped(found)) {
    last_usable_ = stamp;
    first_usable_ = first_usable_.value_or(stamp);
  }
  return found;
}

double ScanStream::prediction_time_s() const { return std::min(interval_s_, kMaxPrediction_s); }

FrameStatus ScanStream::obstacle(std::size_t points) const {
  if (points < static_cast<std::size_t>(config_.min_points)) {
    return FrameStatus::kTooFewPoints;
  }
  if (!last_usable_) {
    return FrameStatus::kFirst;
  }
  if (interval_s_ < min_interval_s_) {
    return FrameStatus::kTooSoon;
  }
  return interval_s_ > config_.max_gap_s ? FrameStatus::kTimeGap : FrameStatus::kNotRun;
}

void ScanStream::state(StateArchive& archive) {
  archive(first_usable_, last_usable_, last_, elapsed_s_, interval_s_, since_any_s_);
  archive.require(first_usable_.has_value() == last_usable_.has_value() &&
                      (!last_usable_ || (last_ && *first_usable_ <= *last_usable_ && *last_usable_ <= *last_)),
                  "the order of scans");
}

double ScanStream::last_usable_s() const { return last_usable_ ? seconds_between(*first_usable_, *last_usable_) : 0.0; }

bool is_skipped(FrameStatus obstacle) {
  return obstacle == FrameStatus::kTooFewPoints || obstacle == FrameStatus::kTooSoon;
}

}  // namespace dynamic_icp::odometry
