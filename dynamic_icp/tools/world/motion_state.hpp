// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dynamic_icp::world {

/// Where a body is and how it moves at one time. The twist is the exact time derivative of the pose.
struct MotionState {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world = Eigen::Vector3d::Zero();          ///< m/s, of the body's origin
  Eigen::Vector3d angular_velocity_world = Eigen::Vector3d::Zero();  ///< rad/s
};

/// The motion of a body over the time of a scene (s, 0 at the first scan). Must be free of side effects: it is called
/// from several threads.
using Trajectory = std::function<MotionState(double time_s)>;

/// The velocity (m/s) of the material point of the body that is at `point_world`: v + omega x (p - origin).
Eigen::Vector3d point_velocity(const MotionState& body, const Eigen::Vector3d& point_world);

/// The motion of something fixed to a body at `T_body_part`: its velocity has the lever arm's share.
MotionState mounted(const MotionState& body, const Eigen::Isometry3d& T_body_part);

/// The motion of something that moves on a body: `part` is its motion in the body's frame, in place of the world.
MotionState moving_part(const MotionState& body, const MotionState& part);

}  // namespace dynamic_icp::world
