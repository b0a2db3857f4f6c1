// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/evaluation/consistency.hpp"

// What frame_json.hpp writes, read again.
namespace dynamic_icp::runs {

/// How the sensor moves at the stamp of a scan, in its own axes.
struct TwistRow {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s over ground
  std::optional<Matrix6d> covariance = std::nullopt;  ///< of [angular; linear]; none in runs of earlier versions
};

/// One line of frames.jsonl. Numbers that are null in the file, and an ego velocity that could not be estimated, are
/// NaN here.
struct FrameRow {
  std::size_t index = 0;  ///< of the scan in the recording
  double points = 0.0;
  double points_used = 0.0;
  Eigen::Vector3d ego_velocity = Eigen::Vector3d::Zero();  ///< m/s, sensor frame
  double dynamic_candidates = 0.0;
  double dynamic_clustered = 0.0;
  double dynamic_refined = 0.0;
  double iterations = 0.0;
  bool converged = false;
  std::string status;  ///< "ok", "degenerate" or "lost"
  std::string reason;  ///< more exactly: "first", "converged", "time_gap", ...
  double fitness = 0.0;
  double inlier_rmse = 0.0;                                  ///< m
  double information_ratio = 0.0;                            ///< of the least known direction to the best known one
  std::vector<Vector6d> unobservable_directions;             ///< of the pose, [rotation; translation], unit length
  std::optional<Matrix6d> pose_covariance;                   ///< of T_target_source, where one is stated
  std::optional<TwistRow> twist;                             ///< where the method states one
  double doppler_bias = 0.0;                                 ///< m/s, constant error that was found
  std::vector<std::pair<std::string, double>> milliseconds;  ///< per stage and "total"
};

/// One object of a line of objects.jsonl; everything in the sensor frame of that scan.
struct ObjectRow {
  std::int64_t id = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, over ground
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< m, middle of the box
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();    ///< m, edges of the box along the axes of the sensor
  double points = 0.0;
  /// Box along the object instead of the sensor, where the method states one: turned by `yaw_rad` about the z axis.
  struct Box {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
    Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< m, length, width, height
    double yaw_rad = 0.0;
  };
  std::optional<Box> box = std::nullopt;
  /// What a method that tracks objects states beyond their boxes. NaN where an earlier version stated nothing.
  struct Track {
    std::int64_t age_scans = 0;
    bool tangential_observed = false;     ///< whether the speed across the line of sight was measured
    Eigen::Matrix3d velocity_covariance;  ///< (m/s)^2, sensor frame
    Eigen::Matrix3d centre_covariance;    ///< m^2, sensor frame
    /// Front, rear, left, right, top and bottom: "seen", "hidden" or "unknown".
    std::array<std::string, 6> faces;
  };
  std::optional<Track> track = std::nullopt;
};

/// How the sensor moves at the stamp of a scan, m/s, sensor frame: by the twist where the run tells it, else the ego
/// velocity, which of a scan that sweeps is one for all of the sweep.
inline Eigen::Vector3d velocity_at_stamp(const FrameRow& frame) {
  return frame.twist && frame.twist->linear.allFinite() ? frame.twist->linear : frame.ego_velocity;
}

/// What the run states of the motion into this frame.
evaluation::StatedMotion stated_motion(const FrameRow& frame);

/// The objects of a scan.
struct ObjectsRow {
  std::size_t index = 0;  ///< of the scan in the recording
  std::vector<ObjectRow> objects;
};

/// frames.jsonl and objects.jsonl. Throw DataError naming the file, the line and what was expected when a line is no
/// complete JSON object or a key is missing or of the wrong kind.
std::vector<FrameRow> read_frames(const std::filesystem::path& path);
std::vector<ObjectsRow> read_objects(const std::filesystem::path& path);

}  // namespace dynamic_icp::runs
