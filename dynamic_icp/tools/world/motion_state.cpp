// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/motion_state.hpp"

namespace dynamic_icp::world {

Eigen::Vector3d point_velocity(const MotionState& body, const Eigen::Vector3d& point_world) {
  return body.velocity_world + body.angular_velocity_world.cross(point_world - body.T_world_body.translation());
}

MotionState mounted(const MotionState& body, const Eigen::Isometry3d& T_body_part) {
  MotionState part;
  part.T_world_body = body.T_world_body * T_body_part;
  part.velocity_world = point_velocity(body, part.T_world_body.translation());
  part.angular_velocity_world = body.angular_velocity_world;
  return part;
}

MotionState moving_part(const MotionState& body, const MotionState& part) {
  MotionState moving = mounted(body, part.T_world_body);
  moving.velocity_world += body.T_world_body.linear() * part.velocity_world;
  moving.angular_velocity_world += body.T_world_body.linear() * part.angular_velocity_world;
  return moving;
}

}  // namespace dynamic_icp::world
