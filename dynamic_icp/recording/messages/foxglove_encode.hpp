// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/recording/formats/npy.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

// Messages of Foxglove's schemas as protobuf: what a viewer shows of a recording and of a run. Their descriptions:
// foxglove_schemas.hpp.
namespace dynamic_icp::messages {

/// Names of the messages, as `protobuf_schema` and bags take them.
inline constexpr const char* kPointCloudType = "foxglove.PointCloud";
inline constexpr const char* kFrameTransformsType = "foxglove.FrameTransforms";
inline constexpr const char* kPoseInFrameType = "foxglove.PoseInFrame";
inline constexpr const char* kPosesInFrameType = "foxglove.PosesInFrame";
inline constexpr const char* kSceneUpdateType = "foxglove.SceneUpdate";
inline constexpr const char* kOdometryStateType = "dynamic_icp.OdometryState";

/// A cloud of columns of equal length and shape (N,), packed point by point without padding. Integers of 64 bits, which
/// Foxglove does not have, become float64. Throws std::invalid_argument when the columns differ in length.
PointCloud cloud_of_columns(const Header& header, std::span<const formats::NamedArray> columns);

/// foxglove.PointCloud; its pose is the identity where the cloud has none. Throws std::invalid_argument for types of
/// fields that Foxglove does not have, and for big-endian clouds.
std::string encode_cloud(const PointCloud& cloud);

/// foxglove.FrameTransforms.
std::string encode_transforms(std::span<const StampedTransform> transforms);

/// foxglove.PoseInFrame.
std::string encode_pose(const Header& header, const Eigen::Isometry3d& pose);

/// foxglove.PosesInFrame: a path.
std::string encode_poses(const Header& header, std::span<const Eigen::Isometry3d> poses);

/// A moving object as a viewer shows it: a box with its velocity and a text.
struct SceneObject {
  std::string id;
  Eigen::Isometry3d T_frame_box = Eigen::Isometry3d::Identity();  ///< of the centre of the box
  Eigen::Vector3d size = Eigen::Vector3d::Zero();                 ///< m, along the axes of the box
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();             ///< m/s, in the axes of the frame
  bool is_velocity_known = true;  ///< off: only its part along the line of sight is; drawn fainter
  std::string text;
};

/// foxglove.SceneUpdate: these objects instead of all there were before; they vanish after `lifetime_s` by themselves.
/// The arrow is as long as the way in one second.
std::string encode_scene(const Header& header, std::span<const SceneObject> objects, double lifetime_s);

/// What is plotted over time of the odometry, one a scan.
struct OdometryState {
  Stamp stamp;
  std::string status;  ///< "ok", "degenerate" or "lost"
  std::string reason;
  bool converged = false;
  Eigen::Vector3d ego_velocity_mps = Eigen::Vector3d::Zero();        ///< sensor frame
  Eigen::Vector3d ego_velocity_sigma_mps = Eigen::Vector3d::Zero();  ///< standard deviations; NaN: not stated
  Eigen::Vector3d position_sigma_m = Eigen::Vector3d::Zero();        ///< of the motion from the previous scan
  Eigen::Vector3d rotation_sigma_deg = Eigen::Vector3d::Zero();      ///< likewise
  std::vector<double> pose_covariance;          ///< 6 x 6, row by row, of T_target_source; empty: not stated
  std::vector<double> ego_velocity_covariance;  ///< 3 x 3
  Eigen::Vector3d angular_velocity_dps = Eigen::Vector3d::Zero();  ///< deg/s, sensor axes; NaN: not stated
  double doppler_bias_mps = 0.0;
  std::uint32_t points = 0;
  std::uint32_t points_used = 0;
  std::uint32_t moving_points = 0;
  std::uint32_t objects = 0;
  std::int32_t iterations = 0;
  double inlier_rmse_m = 0.0;
  double time_ms = 0.0;
  double position_error_m = 0.0;  ///< against the ground truth with equal first poses; NaN: none
  double latency_ms = 0.0;        ///< from when the scan was there to its result; NaN: not known
};

/// dynamic_icp.OdometryState, with the speed beside the velocity.
std::string encode_state(const OdometryState& state);

}  // namespace dynamic_icp::messages
