// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/usable_points.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::runs {

void UsablePoints::add(const odometry::Frame& frame) {
  ++scans_;
  unusable_ += frame.status == odometry::FrameStatus::kTooFewPoints ? 1 : 0;
  points_ += frame.points;
  points_used_ += frame.points_used;
  dropped_ += frame.dropped;
}

void UsablePoints::refuse_none(const std::filesystem::path& recording) const {
  if (unusable_ < scans_) {
    return;
  }
  throw DataError(
      fmt::format("{}: none of the {} scans has enough points to work with: of {} points {} have numbers that are not "
                  "finite, {} have numbers that no sensor measures, {} are at the origin, {} out of range, {} flagged "
                  "as unusable by the sensor, {} remain after thinning. The diagnosis of the recording says more",
                  recording.string(), scans_, points_, dropped_.non_finite, dropped_.implausible, dropped_.zero_range,
                  dropped_.out_of_range, dropped_.flagged, points_used_));
}

void UsablePoints::state(StateArchive& archive) {
  archive(scans_, unusable_, points_, points_used_, dropped_.non_finite, dropped_.implausible, dropped_.zero_range,
          dropped_.out_of_range, dropped_.flagged);
}

}  // namespace dynamic_icp::runs
