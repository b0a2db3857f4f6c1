// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/kitti_write.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

TEST(KittiWrite, TwelveNumbersRowByRow) {
  Eigen::Isometry3d quarter_turn = Eigen::Isometry3d::Identity();
  quarter_turn.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  quarter_turn.translation() = Eigen::Vector3d(1.5, -2.25, 1e-7);
  const Trajectory trajectory = {{Stamp{5}, Eigen::Isometry3d::Identity()}, {Stamp{7}, quarter_turn}};
  EXPECT_EQ(format_kitti(trajectory), "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1.5 1 0 0 -2.25 0 0 1 1e-07\n");
}

TEST(KittiWrite, EveryDigitIsKept) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = 0.1 + 0.2;
  EXPECT_NE(format_kitti({{Stamp{0}, pose}}).find("0.30000000000000004"), std::string::npos);
}

TEST(KittiWrite, AFullDiskIsNamed) {
  try {
    write_kitti("/dev/full", {{Stamp{0}, Eigen::Isometry3d::Identity()}});
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()), "/dev/full: cannot write: No space left on device");
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
