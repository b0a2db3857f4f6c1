// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

// The steps that every method makes with a scan.
namespace dynamic_icp::odometry {

/// The configuration, before anything is made from it. Throws UsageError when it is out of range.
template <class PipelineConfig>
const PipelineConfig& checked(const PipelineConfig& config) {
  check(config);
  return config;
}

/// Takes over what is finite and in range into `scan`, whose memory is used again; fills stamp, counts and `labels` (-1
/// for all points) of the frame.
void assign(const ScanView& raw, const PreprocessConfig& config, const Workers& workers, Scan& scan, Frame& frame);

/// Takes over the scan and thins it by the voxel grid.
Scan preprocess(const ScanView& raw, const PreprocessConfig& config, const Workers& workers, Frame& frame);

/// Those of `rows` that are static.
std::vector<std::uint32_t> static_rows(std::vector<std::uint32_t> rows, const std::vector<std::uint8_t>& is_moving);

/// Whether a vehicle can make this motion in `dt_s`; false when it is not finite.
bool is_plausible_motion(const Eigen::Isometry3d& T_target_source, double dt_s);

/// What the status of an alignment means for the frame.
FrameStatus frame_status(registration::AlignStatus status);

/// The same for two scans `dt_s` apart: an alignment that moved farther than any vehicle has diverged.
FrameStatus frame_status(const registration::Alignment& alignment, double dt_s);

/// Sets status and motion of a frame: `T_target_source` from the last usable scan, which stands at `T_world_last`.
void set_motion(Frame& frame, FrameStatus status, const Eigen::Isometry3d& T_world_last,
                const Eigen::Isometry3d& T_target_source);

/// The velocity of the sensor as the motion from the last scan, where that was aligned and not too soon before: for
/// methods that do not look for the velocity itself.
void set_velocity_from_motion(Frame& frame, double dt_s);

/// Whether the pose comes from an alignment, converged or not.
bool is_aligned(FrameStatus status);

}  // namespace dynamic_icp::odometry
