// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/sweep_record.hpp"

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::runs {

void SweepRecord::add(const odometry::Frame& frame, const RawScan& scan) {
  if (frame.status == odometry::FrameStatus::kTooFewPoints) {
    return;
  }
  const motion::SweepReport report = frame.sweep.value_or(motion::sweep_in_data(scan));
  first = first.value_or(report);
  same_times = same_times && report.times == first->times;
  all_deskewed = all_deskewed && report.deskewed;
}

std::string SweepRecord::times() const {
  if (!same_times) {
    return "mixed";
  }
  switch (first.value_or(motion::SweepReport{}).times) {
    case motion::SweepTimes::kInData:
      return "in the data";
    case motion::SweepTimes::kDeclared:
      return search && search->found_sweep() ? "found" : "declared";
    case motion::SweepTimes::kNone:
      break;
  }
  return "none";
}

void SweepRecord::state(StateArchive& archive) {
  bool is_there = first.has_value();
  archive(is_there);
  motion::SweepReport report = first.value_or(motion::SweepReport{});
  archive(report.times, report.duration_s, report.deskewed, same_times, all_deskewed);
  first = is_there ? std::optional(report) : std::nullopt;
}

}  // namespace dynamic_icp::runs
