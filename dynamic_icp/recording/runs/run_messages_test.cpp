// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the messages hold is read by independent readers in tests/interop.
#include "dynamic_icp/recording/runs/run_messages.hpp"

#include <map>
#include <utility>

#include <gtest/gtest.h>

namespace dynamic_icp::runs {
namespace {

using Messages = std::map<std::pair<RunTopic, std::int64_t>, std::string>;

MessageSink into(Messages& messages) {
  return {.write =
              [&](RunTopic topic, Stamp stamp, std::string bytes) {
                messages[{topic, stamp.ns}] = std::move(bytes);
              },
          .wants_points = [] { return false; }};
}

odometry::Frame frame_at(int k) {
  odometry::Frame frame;
  frame.stamp = Stamp{std::int64_t{k} * 100'000'000};
  frame.T_world_sensor.translation() = Eigen::Vector3d(0.5 * k, 0.001 * k * k, 0.0);
  return frame;
}

TEST(RunMessages, PathsHoldTheScansThatAreLeftOutToo) {
  formats::Trajectory truth;
  for (int k = 4; k < 20; ++k) {
    truth.push_back({frame_at(k).stamp, Eigen::Isometry3d::Identity()});
  }
  Messages of_all;
  Messages of_some;
  RunMessages all(into(of_all), truth, {});
  RunMessages some(into(of_some), truth, {});
  for (int k = 0; k < 1300; ++k) {  // the poses in a message are thinned twice
    const odometry::Frame frame = frame_at(k);
    all.add({}, frame, 0.0);
    if (k % 7 == 3 || k == 4 || k % 500 == 499) {
      some.add({}, frame, 0.0);
    } else {
      some.pass({frame.stamp, frame.T_world_sensor});
    }
  }
  EXPECT_EQ(of_some.count({RunTopic::kTruthPath, frame_at(4).stamp.ns}), 1U);
  EXPECT_LT(of_some.size(), of_all.size() / 4);
  for (const auto& [key, bytes] : of_some) {
    const auto same = of_all.find(key);
    ASSERT_NE(same, of_all.end());
    EXPECT_TRUE(bytes == same->second) << run_topics()[static_cast<std::size_t>(key.first)].name << " at "
                                       << key.second;
  }
}

}  // namespace
}  // namespace dynamic_icp::runs
