// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/prediction.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::dynamics {
namespace {

using Eigen::Vector3d;

Scan five_points() {
  RawScan raw;
  raw.points = {{10, 0, 0}, {0, 10, 0}, {20, 0, 0}, {21, 0, 0}, {0, 0, 5}};
  raw.doppler = {1, 2, 3, 4, 5};
  return Scan::from_raw(raw);
}

ObjectEstimate object(const Vector3d& velocity, std::vector<std::uint32_t> members) {
  ObjectEstimate result;
  result.verdict = ClusterVerdict::kAccepted;
  result.velocity_sensor = velocity;
  result.members = std::move(members);
  return result;
}

TEST(Prediction, MovesObjectsAndLeavesTheStaticScene) {
  const Scan scan = five_points();
  const std::vector<std::uint8_t> is_dynamic = {0, 1, 1, 1, 0};
  const std::vector<ObjectEstimate> objects = {object({10, 0, 0}, {2}), object({0, -5, 2}, {3})};
  const Scan source = predict(scan, is_dynamic, objects, 0.1);
  ASSERT_EQ(source.records(), (std::vector<std::uint32_t>{0, 2, 3, 4})) << "row 1 moves but belongs to no object";
  EXPECT_EQ(source.points()[0], Vector3d(10, 0, 0));
  EXPECT_TRUE(source.points()[1].isApprox(Vector3d(21, 0, 0), 1e-15));
  EXPECT_TRUE(source.points()[2].isApprox(Vector3d(21, -0.5, 0.2), 1e-15));
  EXPECT_EQ(source.points()[3], Vector3d(0, 0, 5));
  EXPECT_EQ(source.directions()[2], Vector3d(1, 0, 0)) << "the line of sight is that of the measurement";
  EXPECT_EQ(source.doppler(), (std::vector<double>{1, 3, 4, 5}));
  EXPECT_EQ(scan.points()[2], Vector3d(20, 0, 0)) << "the input is not written to";
}

TEST(Prediction, RejectedClustersAreLeftOut) {
  std::vector<ObjectEstimate> objects(1);
  objects[0].verdict = ClusterVerdict::kTooFewInliers;
  objects[0].velocity_sensor = {99, 99, 99};
  EXPECT_EQ(predict(five_points(), std::vector<std::uint8_t>{0, 1, 1, 0, 0}, objects, 0.1).size(), 3u);
}

TEST(Prediction, AllMovingLeavesNothing) {
  EXPECT_TRUE(predict(five_points(), std::vector<std::uint8_t>(5, 1), {}, 0.1).empty());
  EXPECT_TRUE(predict(Scan{}, {}, {}, 0.1).empty());
}

}  // namespace
}  // namespace dynamic_icp::dynamics
