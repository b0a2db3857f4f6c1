// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_transforms.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"

#include "testing/fake_bag.hpp"

namespace dynamic_icp::datasets {
namespace {

using bags::FakeBag;

constexpr std::int64_t kDriveBegin_ns = 1'700'000'000'000'000'000;

std::int64_t at_ms(std::int64_t ms) { return kDriveBegin_ns + 1'000'000 * ms; }

Eigen::Isometry3d moved(double x, double yaw = 0.0) {
  return Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

const Eigen::Isometry3d kLidarOnMast =
    Eigen::Translation3d(0.1, -0.2, 0.9) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.1, 0.2, 1).normalized());

/// map>odom 10 times a second, odom>base_link 50 times, base_link>mast>lidar repeated with it.
FakeBag bag_of_a_robot(bool mast_is_static) {
  FakeBag bag;
  if (mast_is_static) {
    bag.add_transforms("/tf_static", at_ms(0), {{"base_link", "mast", moved(1.0)}});
  }
  for (std::int64_t ms = 0; ms <= 1000; ms += 20) {
    if (ms % 100 == 0) {
      bag.add_transforms("/tf", at_ms(ms), {{"map", "odom", moved(0.5 + 0.001 * static_cast<double>(ms), 0.3)}});
    }
    bag.add_transforms("/tf", at_ms(ms), {{"odom", "base_link", moved(0.01 * static_cast<double>(ms))}});
    if (!mast_is_static) {
      bag.add_transforms("/tf", at_ms(ms), {{"base_link", "mast", moved(1.0)}});
    }
    bag.add_transforms("/tf", at_ms(ms), {{"mast", "lidar", kLidarOnMast}});
  }
  return bag;
}

TEST(BagTransforms, WhatIsRepeatedWithoutChangeIsStatic) {
  const FakeBag bag = bag_of_a_robot(false);
  StaticFrames frames = read_static_frames(bag);
  EXPECT_TRUE(frames.empty());
  EXPECT_EQ(add_repeated_frames(bag, frames), 2U);
  EXPECT_TRUE(frames.transform("base_link", "lidar")->isApprox(moved(1.0) * kLidarOnMast));
  EXPECT_EQ(frames.base_of("lidar"), "base_link");
  EXPECT_FALSE(frames.transform("odom", "base_link")) << "which moves";
}

TEST(BagTransforms, ASensorThatStandsIsNotFixedToTheWorld) {
  FakeBag bag;
  for (std::int64_t ms = 0; ms < 1000; ms += 100) {
    bag.add_transforms("/tf", at_ms(ms), {{"odom", "base_link", moved(3.0)}, {"base_link", "lidar", kLidarOnMast}});
  }
  StaticFrames frames;
  EXPECT_EQ(add_repeated_frames(bag, frames), 1U);
  EXPECT_EQ(frames.pairs(), std::vector<std::string>{"base_link>lidar"});
}

TEST(BagTransforms, AStaticTransformGoesFirst) {
  FakeBag bag = bag_of_a_robot(true);
  bag.add_transforms("/tf", at_ms(1000), {{"base_link", "mast", moved(7.0)}, {"base_link", "mast", moved(7.0)}});
  StaticFrames frames = read_static_frames(bag);
  EXPECT_EQ(add_repeated_frames(bag, frames), 1U);
  EXPECT_TRUE(frames.transform("base_link", "mast")->isApprox(moved(1.0)));
}

TEST(BagTransforms, PairsAreChained) {
  for (const bool mast_is_static : {true, false}) {
    const FakeBag bag = bag_of_a_robot(mast_is_static);
    StaticFrames frames = read_static_frames(bag);
    add_repeated_frames(bag, frames);
    const RecordedPoses direct = poses_of_pair(bag, "odom>base_link", frames);
    EXPECT_EQ(direct.poses.size(), 51U);
    const RecordedPoses chain = poses_of_pair(bag, "map>lidar", frames);
    EXPECT_EQ(chain.child, "lidar");
    ASSERT_EQ(chain.poses.size(), 51U) << "one for each of the pair that is sent most often";
    for (std::size_t i = 0; i < chain.poses.size(); ++i) {
      const double ms = 20.0 * static_cast<double>(i);
      EXPECT_EQ(chain.headers[i].ns, at_ms(static_cast<std::int64_t>(ms)));
      const Eigen::Isometry3d expected = moved(0.5 + 0.001 * ms, 0.3) * moved(0.01 * ms) * moved(1.0) * kLidarOnMast;
      EXPECT_LT(log_se3(expected.inverse() * chain.poses[i]).norm(), 1e-9) << i;
    }
  }
}

TEST(BagTransforms, FramesThatNothingConnectsAreNamed) {
  FakeBag bag = bag_of_a_robot(true);
  bag.add_transforms("/tf", at_ms(0), {{"a", "b", moved(1.0)}, {"b", "a", moved(1.0)}});
  try {
    (void)poses_of_pair(bag, "map>b", read_static_frames(bag));
    FAIL() << "nothing leads there";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("a>b, b>a, map>odom, mast>lidar, odom>base_link"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
