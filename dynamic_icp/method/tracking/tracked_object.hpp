// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

enum class TrackStatus {
  kTentative,  ///< seen too rarely yet to be believed
  kConfirmed,  ///< seen in this scan
  kCoasting,   ///< believed, but without points in this scan: where and how fast it should be
};
constexpr TrackStatus last_of(TrackStatus /*any*/) { return TrackStatus::kCoasting; }

std::string_view to_string(TrackStatus status);
std::string_view to_string(FaceView view);

enum class MotionModel { kStanding, kStraight, kTurning };

/// How likely each is.
struct MotionProbabilities {
  double standing = 1.0 / 3.0;
  double straight = 1.0 / 3.0;  ///< without turning
  double turning = 1.0 / 3.0;
};

/// Where an object will be, by all that it may do, as likely as that is; axes of the sensor frame at the stamp.
struct ObjectPrediction {
  double after_s = 1.0;                                         ///< since the stamp
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();             ///< m
  Eigen::Matrix3d centre_covariance = Eigen::Matrix3d::Zero();  ///< m^2
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();    ///< m/s
};

/// One moving thing at the stamp of a scan, from all scans in which it was seen. Vectors are in the axes of the sensor
/// frame of that scan.
struct TrackedObject {
  std::int64_t id = 0;            ///< 1, 2, ... in the order of birth; never used again
  std::int64_t divided_from = 0;  ///< id of the object it was taken for a part of, as trailers are; 0: none
  TrackStatus status = TrackStatus::kTentative;
  /// m/s over ground, of the centre of the box: a turning body has another velocity elsewhere.
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the velocity, (m/s)^2
  double yaw_rate_rps = 0.0;                             ///< about the normal of the ground
  double yaw_rate_variance = 0.0;                        ///< (rad/s)^2
  double acceleration_mps2 = 0.0;                        ///< ahead, of an object with heading
  MotionProbabilities motion;
  /// Whether the velocity across the line of sight is known to TrackerConfig::tangential_sigma_mps. Where it is
  /// not, only the part of the velocity along the line of sight should be used.
  bool tangential_observed = false;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();           ///< m, sensor frame: centre of the box
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();             ///< m, the box along the axes of the sensor frame
  OrientedBox box;                                              ///< sensor frame; the first axis points where it moves
  Eigen::Matrix3d centre_covariance = Eigen::Matrix3d::Zero();  ///< m^2, of the centre of the box
  std::array<FaceView, kFaces.size()> faces{};                  ///< of the box, by Face
  ObjectPrediction prediction;
  int age_scans = 0;                   ///< scans since birth, 1 in the scan of birth
  int scans_seen = 0;                  ///< of these, with points
  std::vector<std::uint32_t> members;  ///< its rows of the scan, ascending
};

}  // namespace dynamic_icp::tracking
