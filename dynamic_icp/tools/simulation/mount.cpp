// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/mount.hpp"

#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {

ConfigFields fields(MountConfig& config) {
  return {
      {"x_m", &config.x_m, -20.0, 20.0, "m", "forward of the middle of the vehicle"},
      {"y_m", &config.y_m, -20.0, 20.0, "m", "left of the middle of the vehicle"},
      {"z_m", &config.z_m, 0.1, 20.0, "m", "above the road"},
      {"roll_deg", &config.roll_deg, -180.0, 180.0, "deg", "about the forward axis"},
      {"pitch_deg", &config.pitch_deg, -90.0, 90.0, "deg", "about the left axis: positive looks down"},
      {"yaw_deg", &config.yaw_deg, -180.0, 180.0, "deg", "about the upward axis: positive looks left"},
  };
}

Eigen::Isometry3d T_vehicle_sensor(const MountConfig& mount) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(mount.yaw_deg * kRadians, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(mount.pitch_deg * kRadians, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(mount.roll_deg * kRadians, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() << mount.x_m, mount.y_m, mount.z_m;
  return T;
}

}  // namespace dynamic_icp::simulation
