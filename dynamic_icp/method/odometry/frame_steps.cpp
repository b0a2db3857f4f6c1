// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/frame_steps.hpp"

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::odometry {

void assign(const ScanView& raw, const PreprocessConfig& config, const Workers& workers, Scan& scan, Frame& frame) {
  const Scan::RangeLimits limits{config.range.min_range_m, config.range.max_range_m};
  scan.assign(raw, limits, workers, &frame.dropped);  // Eq. (1)
  frame.stamp = raw.stamp;
  frame.points = raw.points.size();
  frame.labels.assign(frame.points, -1);
}

Scan preprocess(const ScanView& raw, const PreprocessConfig& config, const Workers& workers, Frame& frame) {
  Scan whole;
  assign(raw, config, workers, whole, frame);
  Scan scan = preprocess::voxel_grid(whole, config.voxel, workers);
  frame.points_used = scan.size();
  return scan;
}

std::vector<std::uint32_t> static_rows(std::vector<std::uint32_t> rows, const std::vector<std::uint8_t>& is_moving) {
  std::erase_if(rows, [&](std::uint32_t row) { return is_moving[row] != 0; });
  return rows;
}

bool is_plausible_motion(const Eigen::Isometry3d& T_target_source, double dt_s) {
  return T_target_source.linear().allFinite() && T_target_source.translation().norm() <= kMaxDoppler_mps * dt_s;
}

FrameStatus frame_status(const registration::Alignment& alignment, double dt_s) {
  const FrameStatus status = frame_status(alignment.status);
  const bool has_diverged = is_aligned(status) && !is_plausible_motion(alignment.T_target_source, dt_s);
  return has_diverged ? FrameStatus::kDiverged : status;
}

FrameStatus frame_status(registration::AlignStatus status) {
  switch (status) {
    case registration::AlignStatus::kConverged:
      return FrameStatus::kConverged;
    case registration::AlignStatus::kIterationLimit:
      return FrameStatus::kIterationLimit;
    case registration::AlignStatus::kTooFewCorrespondences:
      return FrameStatus::kTooFewCorrespondences;
    case registration::AlignStatus::kDegenerate:
      return FrameStatus::kDegenerate;
    case registration::AlignStatus::kDiverged:
      return FrameStatus::kDiverged;
    case registration::AlignStatus::kNotRun:
      break;
  }
  return FrameStatus::kNotRun;
}

void set_motion(Frame& frame, FrameStatus status, const Eigen::Isometry3d& T_world_last,
                const Eigen::Isometry3d& T_target_source) {
  frame.status = status;
  frame.T_target_source = T_target_source;
  frame.T_world_sensor = T_world_last * T_target_source.inverse();
}

void set_velocity_from_motion(Frame& frame, double dt_s) {
  if (is_aligned(frame.status) && dt_s >= kMinScanInterval_s) {
    frame.ego.status = ego_motion::EgoVelocityStatus::kFromMotion;
    frame.ego.velocity_sensor = -frame.T_target_source.translation() / dt_s;
  }
}

bool is_aligned(FrameStatus status) {
  return status == FrameStatus::kConverged || status == FrameStatus::kIterationLimit;
}

}  // namespace dynamic_icp::odometry
