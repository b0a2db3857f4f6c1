// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/fmcw_lidar.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

TEST(FmcwLidar, DefaultsAreValid) {
  FmcwLidarConfig config;
  MountConfig mount;
  EXPECT_NO_THROW(check_fields(fields(config)));
  EXPECT_NO_THROW(check_fields(fields(mount)));
}

TEST(FmcwLidar, ImpossibleValuesAreRefused) {
  FmcwLidarConfig config;
  EXPECT_THROW(set_field(fields(config), "rows", "0"), UsageError);
  EXPECT_THROW(set_field(fields(config), "range_noise_m", "-0.1"), UsageError);
  EXPECT_THROW(set_field(fields(config), "dropout_rate", "1.5"), UsageError);
  EXPECT_THROW(set_field(fields(config), "horizontal_fov_deg", "nan"), UsageError);
}

TEST(FmcwLidar, PatternCoversTheFieldOfViewEvenly) {
  FmcwLidarConfig config;
  config.columns = 12;
  config.rows = 4;
  const ScanPattern pattern = instant_pattern(config);
  ASSERT_EQ(pattern.size(), 12U);
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    EXPECT_EQ(pattern[column].time_s, 0.0);
    ASSERT_EQ(pattern[column].directions.size(), 4U);
    for (std::size_t row = 0; row < 4; ++row) {
      const Eigen::Vector3d& u = pattern[column].directions[row];
      EXPECT_NEAR(u.norm(), 1.0, 1e-15);
      EXPECT_NEAR(std::atan2(u.y(), u.x()) * kDegrees, 55.0 - 10.0 * static_cast<double>(column), 1e-12);
      EXPECT_NEAR(std::asin(u.z()) * kDegrees, 7.2 - 4.8 * static_cast<double>(row), 1e-12);
    }
  }
}

TEST(FmcwLidar, MountIsThePoseOfTheSensorOnTheVehicle) {
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
