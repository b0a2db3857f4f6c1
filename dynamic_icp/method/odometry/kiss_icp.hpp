// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/odometry/adaptive_threshold.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

namespace dynamic_icp::odometry {

/// A scan thinned twice.
struct ThinnedScan {
  Scan map_points;  ///< the first point of each voxel of half the edge of the map's: these enter the map
  Scan registered;  ///< of those, the first of each voxel of 1.5 times that edge: these are registered
};

ThinnedScan thin(const Scan& scan, double map_voxel_size_m);

/// KISS-ICP as published (Vizzo et al., IEEE RA-L 2023), which uses no Doppler velocities: robust point-to-point
/// registration of each scan to a local map, from the pose that a constant velocity predicts. It has its own
/// preprocessing. It knows no time between scans, which are taken
/// as evenly spaced; stamps only have to increase.
///
/// Rules and defaults are those of its authors' releases 0.2.10 to 1.2.0. In details it is not their program: voxels
/// are distinguished by rounding down, also below zero, and keep the first point in the order of the scan; a point
/// without neighbours has no correspondence; steps are taken about the predicted pose instead of the origin of the
/// world, so that the stopping rule means the same all along a drive; deskewing begins with the third scan instead of
/// the fourth; fewer than 6 correspondences are a failure.
///
/// What its frames say:
///   - The pose is that of the sensor in the frame of the first usable scan. For a scan that is deskewed it is the pose
///     at the middle of the sweep, and given out as it is with the stamp of the scan. The first two scans, before
///     which no motion is known, and scans without times are not deskewed.
///   - `alignment` is that of the scan to the map in the frame of the predicted pose; its `T_target_source` is the
///     correction of the prediction.
///   - `points_used` and the label 0 stand for the points that are registered. More of them enter the map.
///   - There are no objects; the velocity is the motion from the last scan.
class KissIcp final : public Odometry {
 public:
  /// `threads` = 0 takes as many as the machine has. Throws UsageError when the configuration is out of range.
  explicit KissIcp(const KissIcpConfig& config, int threads = 0);

  /// A scan that cannot be aligned stands at the predicted pose, also in the map, unless it has too few points.
  Frame process(const ScanView& raw) override;

 private:
  [[nodiscard]] Scan deskewed_in_range(const ScanView& raw, Frame& frame) const;
  void register_to_map(const Scan& source, const Eigen::Isometry3d& T_world_predicted, Frame& frame);
  void update_map(const Scan& points, const Eigen::Isometry3d& T_world_sensor);
  void go_on_to(Frame& frame);
  [[nodiscard]] Config configuration() const override { return config_; }
  void state(StateArchive& archive) override;

  KissIcpConfig config_;
  Workers workers_;
  spatial::VoxelHashMap map_;  ///< in the world frame
  AdaptiveThreshold threshold_;
  ScanStream stream_;
  Eigen::Isometry3d T_world_last_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_last_now_ = Eigen::Isometry3d::Identity();  ///< the last motion, also the next by prediction
};

}  // namespace dynamic_icp::odometry
