// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/dynamics/object_velocity.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/motion/sweep_times.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/registration/alignment.hpp"
#include "dynamic_icp/method/tracking/tracked_object.hpp"

namespace dynamic_icp::odometry {

/// What the pose of a frame rests on.
enum class FrameStatus {
  kNotRun,
  kFirst,                  ///< the first usable scan: its pose is the identity
  kConverged,              ///< aligned
  kIterationLimit,         ///< aligned, but still moving after the last iteration
  kTooFewCorrespondences,  ///< not aligned: the predicted motion is kept
  /// Some directions are not known, see Alignment::degenerate. Methods from scan to scan keep the predicted motion
  /// then; with a local map the pose is still the most likely one.
  kDegenerate,
  kAmbiguous,  ///< aligned, but in the last scans two motions explained the Doppler equally well: may be the wrong one
  kTooFewPoints,  ///< not aligned: (almost) empty scan, the predicted motion is kept
  kTimeGap,       ///< not aligned: too long after the last scan, the predicted motion is kept
  kTooSoon,       ///< not aligned: less than kMinScanInterval_s after the last usable scan, which stays the reference
  kDiverged,      ///< not aligned: the alignment left what any vehicle can do, the predicted motion is kept
  kLost,          ///< nothing fits the local map: the predicted motion is kept, the map begins anew
};
constexpr FrameStatus last_of(FrameStatus /*any*/) { return FrameStatus::kLost; }

std::string_view to_string(FrameStatus status);

/// The words for how far the pose of a frame can be relied on, best first. FrameStatus is the reason.
inline constexpr std::array<std::string_view, 3> kVerdicts = {"ok", "degenerate", "lost"};

/// The status in one of these words. A frame is lost when its pose is only predicted.
std::string_view verdict(FrameStatus status);

/// Whether the pose comes from an alignment that met its stopping rule.
inline bool converged(FrameStatus status) { return status == FrameStatus::kConverged; }

/// Where the time of a frame went. Preset `default` sorts the Doppler into cells in kPreprocess, beside
/// the voxel grid, and update the map in kDynamics.
enum class Stage { kPreprocess, kNormals, kEgoMotion, kDynamics, kRegistration };
inline constexpr std::size_t kStageCount = 5;
std::string_view to_string(Stage stage);

/// Milliseconds per stage; reading and writing of files is not part of it.
struct StageTimes {
  std::array<double, kStageCount> ms{};
  double total_ms = 0.0;
};

/// All that the odometry says of one scan.
struct Frame {
  FrameStatus status = FrameStatus::kNotRun;
  Stamp stamp;
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();  ///< from the last usable scan into this one
  registration::Alignment alignment;                                  ///< of that pair; not run for the first scan

  ego_motion::EgoVelocity ego;                     ///< of this scan
  std::optional<motion::Twist> twist;              ///< where the method states one
  std::vector<dynamics::ObjectEstimate> clusters;  ///< of this scan, accepted and rejected
  std::vector<tracking::TrackedObject> tracked;    ///< confirmed objects, where the method tracks them
  std::size_t dynamic_candidates = 0;              ///< points that the velocity filter flags
  std::size_t dynamic_clustered = 0;               ///< of those, in a cluster or track
  std::size_t dynamic_refined = 0;                 ///< of those, in an accepted object or confirmed track

  std::size_t points = 0;       ///< as read
  std::size_t points_used = 0;  ///< after range crop and voxel grid
  Scan::Dropped dropped;
  std::optional<motion::SweepReport> sweep;  ///< empty for methods that never look at times
  /// Points that are static, thinned, in the sensor frame at the stamp (m): what a map is made of. Empty for methods
  /// that do not tell them from moving ones.
  std::vector<Eigen::Vector3d> static_points;
  /// Per point of the scan as read: -1 not used (dropped, not kept by the voxel grid, or moving without an object),
  /// 0 static, k > 0 a member of the k-th accepted object or of the tracked object with this id.
  std::vector<std::int32_t> labels;
  StageTimes times;
};

}  // namespace dynamic_icp::odometry
