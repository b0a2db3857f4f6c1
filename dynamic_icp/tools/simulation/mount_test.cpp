// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/mount.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::simulation {
namespace {

TEST(Mount, DefaultIsValid) {
  MountConfig mount;
  EXPECT_NO_THROW(check_fields(fields(mount)));
}

TEST(Mount, IsThePoseOfTheSensorOnTheVehicle) {
  MountConfig mount{1.0, 2.0, 3.0, 0.0, 90.0, 0.0};
  const Eigen::Isometry3d T = T_vehicle_sensor(mount);
  // Pitched by 90 degrees the sensor looks down: one metre ahead of it is one metre below it.
  EXPECT_TRUE((T * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1.0, 2.0, 2.0), 1e-12));
  mount = {0.0, 0.0, 0.0, 0.0, 0.0, 90.0};
  EXPECT_TRUE((T_vehicle_sensor(mount) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  mount = {0.0, 0.0, 0.0, 90.0, 0.0, 0.0};
  EXPECT_TRUE((T_vehicle_sensor(mount) * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

}  // namespace
}  // namespace dynamic_icp::simulation
