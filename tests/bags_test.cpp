// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What `info` and `run` say of bags: their topics, and the options that a message names.
#include <nlohmann/json.hpp>

#include "testing/bags_by_hand.hpp"
#include "testing/ros_bytes.hpp"
#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Bags : public ProgramTest {};

/// A ROS 1 bag of a few clouds and odometry; topics by name, whose points have these fields.
void write_bag(const fs::path& path, const std::vector<std::pair<std::string, std::vector<std::string>>>& clouds) {
  constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;
  std::vector<by_hand::Channel> channels = {{0, "/odom", "nav_msgs/Odometry", "of odometry"}};
  std::vector<by_hand::Message> messages;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t stamp_ns = kBegin_ns + 100'000'000 * i;
    const Eigen::Isometry3d pose(Eigen::Translation3d(i, 0, 0));
    messages.push_back(
        {0, stamp_ns,
         ros::Writer(ros::Wire::kRos1).header(stamp_ns, "odom").text("base").pose(pose).doubles(78).bytes()});
    for (std::uint16_t k = 0; k < clouds.size(); ++k) {
      const std::vector<std::vector<float>> points(2, std::vector<float>(clouds[k].second.size(), 1.5F));
      messages.push_back({static_cast<std::uint16_t>(k + 1), stamp_ns + 1'000'000,
                          ros::float_cloud(stamp_ns, "lidar", clouds[k].second, points).bytes(ros::Wire::kRos1)});
    }
  }
  for (const auto& [name, fields] : clouds) {
    channels.push_back({static_cast<std::uint16_t>(channels.size()), name, "sensor_msgs/PointCloud2", "of clouds"});
  }
  write_file(path, by_hand::ros1_bag(channels, messages, {}));
}

TEST_F(Bags, InfoListsTheTopics) {
  const fs::path bag = folder_ / "a.bag";
  write_bag(bag, {{"/points", {"x", "y", "z", "velocity"}}});
  const Outcome text = run_program("info " + bag.string());
  EXPECT_EQ(text.status, kDone) << text.text;
  EXPECT_NE(text.text.find("topic        /odom: nav_msgs/Odometry, 3 messages at 10.0 Hz\n"), std::string::npos)
      << text.text;
  EXPECT_NE(text.text.find("/points: sensor_msgs/PointCloud2, 3 messages at 10.0 Hz; x, y, z, velocity (float32)"),
            std::string::npos)
      << text.text;
  EXPECT_NE(text.text.find("scans        3\n"), std::string::npos) << text.text;
  const json info = json::parse(run_program("info --json --truth-topic /odom " + bag.string()).text);
  ASSERT_EQ(info["topics"].size(), 2U);
  EXPECT_EQ(info["topics"][1]["fields"][3]["name"], "velocity");
  EXPECT_EQ(info["topics"][1]["fields"][3]["type"], "float32");
  EXPECT_NEAR(info["topics"][0]["rate_hz"].get<double>(), 10.0, 1e-6);
  EXPECT_EQ(info["ground_truth"]["poses"], 3);
}

TEST_F(Bags, InfoOfOneWithoutCloudsSaysSo) {
  const fs::path bag = folder_ / "a.bag";
  write_bag(bag, {});
  const Outcome text = run_program("info " + bag.string());
  EXPECT_EQ(text.status, kDone) << text.text;
  EXPECT_NE(text.text.find("scans        none: no topic holds clouds of points"), std::string::npos) << text.text;
  EXPECT_EQ(json::parse(run_program("info --json " + bag.string()).text)["scans"], 0);
  const Outcome ran = run_program("run " + bag.string() + " --output " + (folder_ / "out").string());
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_NE(ran.text.find("holds no clouds of points"), std::string::npos) << ran.text;
}

TEST_F(Bags, TheOptionThatAMessageNamesHelps) {
  const fs::path bag = folder_ / "a.bag";
  write_bag(bag, {{"/front", {"x", "y", "z", "velocity"}}, {"/rear", {"x", "y", "z", "velocity"}}});
  const Outcome several = run_program("info " + bag.string());
  EXPECT_EQ(several.status, kFailed);
  EXPECT_NE(several.text.find("--topic /front"), std::string::npos) << several.text;
  EXPECT_EQ(run_program("info " + bag.string() + " --topic /front").status, kDone);
  EXPECT_EQ(run_program("info " + bag.string() + " --topic /side").status, kWrongUsage);
  write_bag(bag, {{"/front", {"x", "y", "z", "speed_mps"}}, {"/rear", {"x", "y", "z"}}});
  const Outcome unknown = run_program("info " + bag.string());
  EXPECT_NE(unknown.text.find("--topic /front --field doppler=speed_mps"), std::string::npos) << unknown.text;
  EXPECT_EQ(run_program("info " + bag.string() + " --topic /front --field doppler=speed_mps").status, kDone);
}

}  // namespace
}  // namespace dynamic_icp::tests
