// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/room.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// A box of 2.5 m of width that points to `yaw`.
OrientedBox box_at(double x, double y, double length_m, double yaw = 0.0) {
  return {{x, y, 1.0}, upright_axes(yaw), {length_m, 2.5, 3.0}};
}

TEST(Room, EndsWhereTheNextBodyInTheLaneBegins) {
  const OrientedBox body = box_at(0.0, 0.0, 6.0);
  const Room before = room_beside(body, body, box_at(10.0, 0.5, 10.0));
  EXPECT_NEAR(before.ahead, 2.0, 1e-9);
  EXPECT_DOUBLE_EQ(before.behind, kUnlimited_m);
  const Room after = room_beside(body, body, box_at(-10.0, 0.5, 10.0));
  EXPECT_NEAR(after.behind, 2.0, 1e-9);
  EXPECT_DOUBLE_EQ(after.ahead, kUnlimited_m);
  EXPECT_DOUBLE_EQ(room_beside(body, body, box_at(7.0, 0.0, 10.0)).ahead, 0.0) << "one reaches into the other";
}

TEST(Room, IsAheadOfTheBodyWhicheverWayItAndTheOtherOnePoint) {
  const OrientedBox body = box_at(0.0, 0.0, 6.0, std::numbers::pi);
  EXPECT_NEAR(room_beside(body, body, box_at(-10.0, 0.0, 10.0)).ahead, 2.0, 1e-9);
  EXPECT_NEAR(room_beside(body, body, box_at(10.0, 0.0, 10.0, std::numbers::pi)).behind, 2.0, 1e-9);
}

TEST(Room, OthersBesideTheLaneOrAcrossItLeaveAll) {
  const OrientedBox body = box_at(0.0, 0.0, 6.0);
  for (const OrientedBox& other :
       {box_at(10.0, 2.0, 10.0), box_at(10.0, -3.5, 10.0), box_at(10.0, 0.0, 10.0, 0.5 * std::numbers::pi)}) {
    const Room room = room_beside(body, body, other);
    EXPECT_DOUBLE_EQ(room.ahead, kUnlimited_m);
    EXPECT_DOUBLE_EQ(room.behind, kUnlimited_m);
  }
}

TEST(Room, TheLaneIsAsWideAsTheBodyIsLikelyToBe) {
  // Of the body its left side alone was seen, which is before the right half of the other one.
  OrientedBox seen = box_at(0.0, 1.2, 6.0);
  seen.size.y() = 0.1;
  EXPECT_NEAR(room_beside(seen, box_at(0.0, 0.0, 9.0), box_at(10.0, 0.0, 10.0)).ahead, 2.0, 1e-9);
  EXPECT_DOUBLE_EQ(room_beside(seen, box_at(0.0, 2.4, 9.0), box_at(10.0, 0.0, 10.0)).ahead, kUnlimited_m);
}

}  // namespace
}  // namespace dynamic_icp::tracking
