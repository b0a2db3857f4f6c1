// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/truth.hpp"

#include <array>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

formats::StampedPose pose_at(double x, double y) {
  formats::StampedPose pose;
  pose.T_world_sensor.translation() = Eigen::Vector3d(x, y, 0);
  return pose;
}

TEST(Truth, OnlyLargeCoordinatesAreMoved) {
  const formats::Trajectory small = near_origin({pose_at(9000, 1), pose_at(11000, 2)});
  EXPECT_EQ(small[0].T_world_sensor.translation(), Eigen::Vector3d(9000, 1, 0));
  const formats::Trajectory large = near_origin({pose_at(1, -4e6), pose_at(3, -4e6 + 0.5)});
  EXPECT_EQ(large[0].T_world_sensor.translation(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(large[1].T_world_sensor.translation(), Eigen::Vector3d(2, 0.5, 0));
  EXPECT_TRUE(near_origin({}).empty());
}

TEST(Truth, MissingFilesArePassedOver) {
  std::vector<std::string> assumptions;
  const Truth truth =
      named_truth(std::array{std::filesystem::path(), std::filesystem::path("/no/such/file")}, {Stamp{0}}, assumptions);
  EXPECT_TRUE(truth.poses.empty() && truth.file.empty() && assumptions.empty());
}

TEST(Truth, TransformsComeRowByRow) {
  const std::array<double, 12> rows = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3};
  EXPECT_TRUE((rigid_transform(rows, "a") * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  const std::array<double, 12> mirrored = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  EXPECT_THROW(rigid_transform(mirrored, "a"), DataError);
  const std::array<double, 3> few = {1, 2, 3};
  EXPECT_THROW(rigid_transform(few, "a"), DataError);
}

TEST(Truth, NumbersStandBetweenBlanksAndCommas) {
  EXPECT_EQ(numbers_in(" 1,-2.5\t3e2 \r", "a"), (std::vector<double>{1, -2.5, 300}));
  EXPECT_TRUE(numbers_in("", "a").empty());
  EXPECT_THROW(numbers_in("1 x", "a"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::datasets
