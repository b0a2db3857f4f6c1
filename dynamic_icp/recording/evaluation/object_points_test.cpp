// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_points.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

/// A car of 4 x 2 x 2 m, 20 m ahead, and itself as what is reported of it.
BodyPair held_car() {
  BodyPair pair;
  pair.truth.id = 3;
  pair.truth.box = {Eigen::Isometry3d(Eigen::Translation3d(20.0, 0.0, 0.0)), {4.0, 2.0, 2.0}};
  pair.reported = pair.truth;
  return pair;
}

std::optional<Eigen::Isometry3d> at_rest(double /*time_s*/) { return Eigen::Isometry3d::Identity(); }

TEST(ObjectPoints, DistanceToATurnedBox) {
  Box box = held_car().reported.box;
  box.T_sensor_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(distance_to(box, {20.9, 1.9, 0.9}), 0.0);
  EXPECT_NEAR(distance_to(box, {21.3, 2.4, 0.0}), 0.5, 1e-12) << "0.3 and 0.4 m off";
}

TEST(ObjectPoints, ThoseOfTheBodyAloneCount) {
  const std::vector<Eigen::Vector3d> points = {
      {18.0, 0.0, 0.0}, {17.86, 0.0, 0.0}, {17.84, 0.0, 0.0}, {20.0, 1.0, 0.0}, {30.0, 0.0, 0.0}};
  const std::vector<std::int32_t> labels = {3, 3, 3, 3, 0};
  EXPECT_EQ(held_share(held_car(), {points, {}, labels}, at_rest), 0.75) << "one is 0.16 m before the box";
  EXPECT_FALSE(held_share(held_car(), {points, {}, std::vector<std::int32_t>(5, 0)}, at_rest));
  EXPECT_THROW(held_share(held_car(), {points, {}, std::vector<std::int32_t>(4, 3)}, at_rest), std::invalid_argument);
}

TEST(ObjectPoints, TheReportedBoxHoldsThem) {
  BodyPair pair = held_car();
  pair.reported.box.size.x() = 3.0;
  const std::vector<Eigen::Vector3d> points = {{18.0, 0.0, 0.0}, {19.0, 0.0, 0.0}};
  EXPECT_EQ(held_share(pair, {points, {}, std::vector<std::int32_t>(2, 3)}, at_rest), 0.5);
}

/// The sensor drives and turns, the body drives and turns about its centre: the place of one of its corners 0.1 s after
/// the stamp, by their poses in the world.
TEST(ObjectPoints, OfASweepAreMovedToItsStamp) {
  constexpr double kTime_s = 0.1;
  BodyPair pair = held_car();
  pair.truth.velocity << 15.0, 6.0, 0.0;
  pair.truth.yaw_rate_rps = 1.5;
  const Eigen::Isometry3d T_world_sensor =
      Eigen::Translation3d(1.2, 0.1, 0.0) * Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.0, 0.6, 0.8));
  const Eigen::Isometry3d T_world_body =
      Eigen::Translation3d(21.5, 0.6, 0.0) * Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d corner(-2.0, 1.0, -1.0);
  const std::vector<Eigen::Vector3d> points = {T_world_sensor.inverse() * (T_world_body * corner)};
  const std::vector<double> times = {kTime_s};
  const std::vector<std::int32_t> labels = {3};
  const auto sensor = [&](double time_s) {
    EXPECT_EQ(time_s, kTime_s);
    return std::optional(T_world_sensor);
  };
  // A box that ends so far before the corner that 0.151 m are too much and 0.149 m are not.
  for (const auto& [missing_m, share] : {std::pair(0.149, 1.0), std::pair(0.151, 0.0)}) {
    pair.reported.box.size << 4.0 - 2.0 * missing_m, 2.0, 2.0;
    EXPECT_EQ(held_share(pair, {points, times, labels}, sensor), share) << missing_m;
  }
  const auto unknown = [](double) { return std::optional<Eigen::Isometry3d>(); };
  EXPECT_FALSE(held_share(pair, {points, times, labels}, unknown));
}

TEST(ObjectPoints, SharesInTwoNumbers) {
  std::vector<double> shares;
  for (int k = 100; k >= 0; --k) {
    shares.push_back(0.01 * k);
  }
  EXPECT_NEAR(*held_points(shares).median, 0.5, 1e-12);
  EXPECT_NEAR(*held_points(shares).p5, 0.05, 1e-12);
  EXPECT_FALSE(held_points({}).median);
}

TEST(ObjectPoints, GhostsAreStaticPointsOnMovingBodies) {
  StaticPoints points;
  EXPECT_FALSE(points.share_on_moving());
  points.add(std::vector<std::int32_t>{0, 0, 0, 0, 7, -1}, std::vector<std::int32_t>{0, 2, -1, 0, 2, 2});
  EXPECT_EQ(points.share_on_moving(), 0.25) << "rain moves no body";
  EXPECT_THROW(points.add(std::vector<std::int32_t>{0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::evaluation
