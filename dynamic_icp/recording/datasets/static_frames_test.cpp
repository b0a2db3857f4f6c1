// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/static_frames.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::datasets {
namespace {

messages::StampedTransform link(const std::string& parent, const std::string& child, double x) {
  messages::StampedTransform transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.T_parent_child.translation().x() = x;
  transform.T_parent_child.rotate(Eigen::AngleAxisd(0.5 * x, Eigen::Vector3d::UnitZ()));
  return transform;
}

TEST(StaticFrames, ChainsLeadUpAndDown) {
  StaticFrames frames;
  const messages::StampedTransform left = link("base_link", "left", 1.0);
  const messages::StampedTransform right = link("base_link", "right", 2.0);
  const messages::StampedTransform lens = link("right", "right_lens", 0.25);
  for (const auto& one : {left, lens, right}) {
    frames.add(one);
  }
  EXPECT_TRUE(frames.transform("left", "right_lens")
                  ->isApprox(left.T_parent_child.inverse() * right.T_parent_child * lens.T_parent_child));
  EXPECT_TRUE(
      frames.transform("right_lens", "base_link")->isApprox((right.T_parent_child * lens.T_parent_child).inverse()));
  EXPECT_TRUE(frames.transform("anything", "anything")->isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(frames.transform("left", "camera"));
  EXPECT_EQ(frames.pairs(), (std::vector<std::string>{"base_link>left", "base_link>right", "right>right_lens"}));
}

TEST(StaticFrames, TheVehicleIsFoundByName) {
  StaticFrames frames;
  frames.add(link("map", "odom", 0.0));
  frames.add(link("odom", "robot/base_footprint", 0.0));
  frames.add(link("robot/base_footprint", "robot/Base_Link", 0.0));
  frames.add(link("robot/Base_Link", "mast", 0.0));
  frames.add(link("mast", "lidar", 0.0));
  frames.add(link("rig", "post", 0.0));
  frames.add(link("post", "radar", 0.0));
  frames.add(link("world", "camera", 0.0));
  EXPECT_EQ(frames.base_of("lidar"), "robot/Base_Link");
  EXPECT_EQ(frames.base_of("robot/Base_Link"), "robot/base_footprint");
  EXPECT_EQ(frames.base_of("radar"), "rig");  // no known name: the uppermost
  EXPECT_EQ(frames.base_of("camera"), "");    // the world is no vehicle
  EXPECT_EQ(frames.base_of("unknown"), "");
}

TEST(StaticFrames, ARingEnds) {
  StaticFrames frames;
  frames.add(link("a", "b", 1.0));
  frames.add(link("b", "a", 1.0));
  frames.add(link("c", "c", 1.0));
  EXPECT_TRUE(frames.transform("a", "b"));
  EXPECT_FALSE(frames.transform("a", "c"));
  EXPECT_FALSE(frames.base_of("a").empty());
}

}  // namespace
}  // namespace dynamic_icp::datasets
