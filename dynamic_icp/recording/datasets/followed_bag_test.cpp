// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// MCAP files that come bit by bit, against the same files when they are finished.
#include "dynamic_icp/recording/datasets/followed_bag.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/growing_bytes.hpp"
#include "dynamic_icp/recording/datasets/read_ahead.hpp"

#include "testing/bags_by_hand.hpp"
#include "testing/ros_bytes.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using by_hand::Channel;
using by_hand::Layout;
using by_hand::Message;
using ros::Wire;

constexpr std::int64_t kFollowedBegin_ns = 1'700'000'000'000'000'000;
constexpr std::size_t kDriveScans = 14;
constexpr std::size_t kOpenedWith = 4;  // scans with which it is opened
const std::vector<std::string> kCloudFields = {"x", "y", "z", "velocity"};

std::int64_t at_ns(double seconds) {
  return kFollowedBegin_ns + static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

std::vector<Channel> channels_of_drive() {
  return {{1, "/lidar", "sensor_msgs/msg/PointCloud2", "", "cdr"},
          {2, "/tf_static", "tf2_msgs/msg/TFMessage", "", "cdr"},
          {3, "/imu", "sensor_msgs/msg/Imu", "", "cdr"},
          {4, "/right", "sensor_msgs/msg/PointCloud2", "", "cdr"}};
}

std::string transform(const std::string& child, double y) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(1.5, y, 2.0);
  return ros::Writer(Wire::kCdrLittle)
      .put(std::uint32_t{1})
      .header(kFollowedBegin_ns, "base_link")
      .text(child)
      .pose(T)
      .bytes();
}

/// A cloud of a few points that differ from scan to scan, recorded 7 ms after its stamp.
Message cloud_of(std::uint16_t channel, double seconds, int number) {
  std::vector<std::vector<float>> points;
  for (int k = 0; k < 20 + number; ++k) {
    const auto value = static_cast<float>(k + 100 * number);
    points.push_back({value, 0.5F * value, 1.0F, 0.25F * value});
  }
  const std::string frame = channel == 1 ? "lidar" : "right";
  return {channel, at_ns(seconds + 0.007),
          ros::float_cloud(at_ns(seconds), frame, kCloudFields, points).bytes(Wire::kCdrLittle)};
}

/// A drive of one sensor, or of two.
std::vector<Message> drive(bool is_rig = false) {
  std::vector<Message> messages = {{2, kFollowedBegin_ns, transform("lidar", 0.0)},
                                   {2, kFollowedBegin_ns, transform("right", -1.0)}};
  for (int i = 0; i < static_cast<int>(kDriveScans); ++i) {
    messages.push_back({3, at_ns(0.1 * i), std::string(40, 'i')});
    messages.push_back(cloud_of(1, 0.1 * i, i));
    if (is_rig && i != 6) {  // a cloud that is missing
      messages.push_back(cloud_of(4, 0.1 * i + 0.02, 50 + i));
    }
  }
  return messages;
}

Layout layout_of(const std::string& compression) {
  Layout layout;
  layout.compression = compression;
  layout.is_chunked = compression != "unchunked";
  layout.chunk_messages = 5;
  return layout;
}

bool never() { return false; }

void expect_same(const RawScan& a, const RawScan& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.doppler, b.doppler);
  EXPECT_EQ(a.directions, b.directions);
  EXPECT_EQ(a.channels.sensor, b.channels.sensor);
}

class FollowedBagTest : public benchmark::FolderTest {
 protected:
  [[nodiscard]] fs::path file() const { return folder_ / "drive.mcap"; }

  /// Calls `write` with pieces of odd lengths, which cut records and chunks.
  static void in_pieces(const std::string& content, const std::function<void(std::string_view)>& write) {
    constexpr std::array<std::size_t, 6> kLengths = {1, 3, 700, 11, 4097, 257};
    std::size_t at = 0;
    for (std::size_t k = 0; at < content.size(); ++k) {
      const std::size_t length = std::min(kLengths[k % kLengths.size()], content.size() - at);
      write(std::string_view(content).substr(at, length));
      at += length;
      if (k % 4 == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  }

  /// All scans of what comes through a pipe, which is closed at the end.
  struct Followed {
    std::vector<RawScan> scans;
    std::vector<std::string> notes;
    std::string fault;
    std::optional<Eigen::Isometry3d> T_vehicle_sensor;
  };
  static Followed follow_stream(const std::string& content, const InputSettings& settings = {}) {
    std::array<int, 2> ends = {};
    EXPECT_EQ(::pipe(ends.data()), 0);
    std::thread writer([&] {
      in_pieces(content, [&](std::string_view piece) { EXPECT_GT(::write(ends[1], piece.data(), piece.size()), 0); });
      ::close(ends[1]);
    });
    Followed followed;
    try {
      const auto dataset = follow_bag(std::make_unique<bags::FollowedMcap>(bags::growing_stream(ends[0], "a stream")),
                                      {}, settings, kOpenedWith);
      EXPECT_TRUE(dataset->wait_for(0, never));
      followed.T_vehicle_sensor = dataset->T_vehicle_sensor();
      for (ReadAhead reader(*dataset, 0, 1000); !reader.done();) {
        followed.scans.push_back(reader.next());
        EXPECT_TRUE(reader.arrival());
        followed.notes.insert(followed.notes.end(), reader.notes().begin(), reader.notes().end());
      }
      const std::vector<std::string> last = dataset->take_notes();
      followed.notes.insert(followed.notes.end(), last.begin(), last.end());
    } catch (const DataError& error) {
      followed.fault = error.what();
    }
    writer.join();
    ::close(ends[0]);
    return followed;
  }

  void expect_as_finished(const std::vector<RawScan>& scans, const std::string& content,
                          const InputSettings& settings = {}) const {
    write_file(folder_ / "finished.mcap", content);
    const std::unique_ptr<Dataset> finished = open_input(folder_ / "finished.mcap", settings);
    ASSERT_EQ(scans.size(), finished->size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      expect_same(scans[i], finished->scan(i));
    }
  }
};

TEST_F(FollowedBagTest, AStreamInOddPiecesHasTheScansOfTheFinishedFile) {
  for (const char* const compression : {"none", "lz4", "zstd", "unchunked"}) {
    const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of(compression));
    const Followed followed = follow_stream(content);
    EXPECT_EQ(followed.fault, "") << compression;
    EXPECT_TRUE(followed.notes.empty()) << followed.notes.front();
    expect_as_finished(followed.scans, content);
    ASSERT_TRUE(followed.T_vehicle_sensor);
    EXPECT_EQ(followed.T_vehicle_sensor->translation(), Eigen::Vector3d(1.5, 0.0, 2.0));
  }
}

TEST_F(FollowedBagTest, ARigIsMadeOfTheSameClouds) {
  InputSettings settings;
  settings.open.topics = {"/lidar", "/right"};
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(true), layout_of("zstd"));
  expect_as_finished(follow_stream(content, settings).scans, content, settings);
}

TEST_F(FollowedBagTest, CorrectionsHoldForScansThatComeLater) {
  InputSettings settings;
  settings.correction.time_scale = 2.0;
  settings.correction.doppler_scale = 0.5;
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("lz4"));
  expect_as_finished(follow_stream(content, settings).scans, content, settings);
}

TEST_F(FollowedBagTest, AFileIsWaitedForUntilItsEndMark) {
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("unchunked"));
  write_file(file(), "");
  std::thread writer([&] {
    std::ofstream out(file(), std::ios::binary | std::ios::app);
    in_pieces(content, [&](std::string_view piece) { out << piece << std::flush; });
  });
  const auto followed = follow_input(file(), {}, {.count = kOpenedWith}, never);
  ASSERT_TRUE(followed);
  std::vector<RawScan> scans;
  for (ReadAhead reader(*followed, 0, 1000); !reader.done();) {
    scans.push_back(reader.next());
  }
  writer.join();
  expect_as_finished(scans, content);
  EXPECT_TRUE(followed->take_notes().empty());
  expect_same(followed->scan(2), scans[2]);  // a file is not forgotten
}

TEST_F(FollowedBagTest, ACutStreamEndsWithWhatCameAndSaysWhere) {
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("none"));
  for (const double part : {0.4, 0.55, 0.7}) {
    const std::string cut = content.substr(0, static_cast<std::size_t>(part * static_cast<double>(content.size())));
    const Followed followed = follow_stream(cut);
    EXPECT_EQ(followed.fault, "");
    EXPECT_LT(followed.scans.size(), kDriveScans);
    EXPECT_GE(followed.scans.size(), kOpenedWith);
    expect_as_finished(followed.scans, cut);
    ASSERT_EQ(followed.notes.size(), 1U);
    EXPECT_NE(followed.notes[0].find("a stream: cut short at byte " + std::to_string(cut.size())), std::string::npos)
        << followed.notes[0];
  }
}

TEST_F(FollowedBagTest, GarbageEndsItAfterTheScansBeforeAndTheByteIsSaid) {
  std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("unchunked"));
  const std::size_t end = content.find("\x0F" + by_hand::number(std::uint64_t{4}));
  const std::string spoiled = content.substr(0, end) + "what is this? no record of an MCAP file";
  const Followed followed = follow_stream(spoiled);
  EXPECT_EQ(followed.scans.size(), kDriveScans);
  EXPECT_NE(followed.fault.find("a stream: byte " + std::to_string(end) + ": "), std::string::npos) << followed.fault;
  EXPECT_NE(follow_stream("neither MCAP nor anything else").fault.find("a stream: byte 0: "), std::string::npos);
  EXPECT_NE(follow_stream("").fault.find("a stream: ends at byte 0, before the mark"), std::string::npos);
}

TEST_F(FollowedBagTest, DamageAnywhereEndsItWithScansThatAreRight) {
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("zstd"));
  const std::vector<RawScan> right = follow_stream(content).scans;
  for (std::size_t at = 0; at < content.size(); at += 1 + content.size() / 60) {
    std::string spoiled = content;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 0x41);
    const Followed followed = follow_stream(spoiled);
    ASSERT_LE(followed.scans.size(), kDriveScans) << at;
    for (std::size_t i = 0; i < followed.scans.size(); ++i) {
      expect_same(followed.scans[i], right[i]);
    }
    EXPECT_TRUE(followed.scans.size() == kDriveScans || !followed.fault.empty() || !followed.notes.empty()) << at;
  }
}

TEST_F(FollowedBagTest, ASenderThatComesLaterIsTakenForTheTopicItHas) {
  std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("unchunked"));
  content.resize(content.find("\x0F" + by_hand::number(std::uint64_t{4})));
  const Channel again = {9, "/lidar", "sensor_msgs/msg/PointCloud2", "", "cdr"};
  const Channel other = {12, "/late", "sensor_msgs/msg/PointCloud2", "", "cdr"};
  for (const Channel& channel : {again, other}) {
    content += by_hand::mcap_schema(channel) + by_hand::mcap_channel(channel);
  }
  for (int i = 0; i < 3; ++i) {
    Message message = cloud_of(1, 2.0 + 0.1 * i, i);
    message.channel = 9;
    content += by_hand::mcap_message(message);
    message.channel = 12;
    content += by_hand::mcap_message(message);
  }
  const Followed followed = follow_stream(content);
  EXPECT_EQ(followed.fault, "");
  EXPECT_EQ(followed.scans.size(), kDriveScans + 3);
  InputSettings settings;
  settings.open.topics = {"/lidar"};
  expect_as_finished(followed.scans, content, settings);
  ASSERT_EQ(followed.notes.size(), 1U);
  EXPECT_NE(followed.notes[0].find("before its end mark"), std::string::npos) << followed.notes[0];
}

TEST_F(FollowedBagTest, AStampThatGoesBackCostsOneScanAndAClockThatDoesEndsIt) {
  std::vector<Message> messages = drive();
  for (Message& message : messages) {
    if (message.channel == 1 && message.time_ns == at_ns(0.9 + 0.007)) {
      message = cloud_of(1, 0.25, 9);
      message.time_ns = at_ns(0.9 + 0.007);
    }
  }
  const Followed one = follow_stream(by_hand::mcap_file(channels_of_drive(), messages, layout_of("zstd")));
  EXPECT_EQ(one.fault, "");
  EXPECT_EQ(one.scans.size(), kDriveScans - 1);
  ASSERT_EQ(one.notes.size(), 1U);
  EXPECT_NE(one.notes[0].find("/lidar, message 9: is left out: its timestamp"), std::string::npos) << one.notes[0];
  for (int i = 0; i < 15; ++i) {  // the clock of sensor and recorder is set back by an hour
    messages.push_back(cloud_of(1, 0.1 * i - 3600.0, i));
  }
  const Followed all = follow_stream(by_hand::mcap_file(channels_of_drive(), messages, layout_of("zstd")));
  EXPECT_EQ(all.scans.size(), kDriveScans - 1);
  EXPECT_NE(all.fault.find("the clock of '/lidar' went back"), std::string::npos) << all.fault;
}

TEST_F(FollowedBagTest, AFileThatGoesAwayShrinksOrIsReplacedIsAnError) {
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("unchunked"));
  const std::string part = content.substr(0, content.size() * 2 / 3);
  const auto fault_after = [&](const std::function<void()>& change) {
    fs::remove(file());
    write_file(file(), part);
    const auto followed = follow_input(file(), {}, {.count = kOpenedWith}, never);
    std::thread changer(change);
    std::string fault;
    try {
      for (ReadAhead reader(*followed, 0, 1000); !reader.done();) {
        static_cast<void>(reader.next());
      }
    } catch (const DataError& error) {
      fault = error.what();
    }
    changer.join();
    EXPECT_GE(followed->size(), kOpenedWith);
    return fault;
  };
  const std::string bytes = std::to_string(part.size());
  EXPECT_NE(
      fault_after([&] { fs::remove(file()); }).find("was removed or renamed while it was followed, after " + bytes),
      std::string::npos);
  EXPECT_NE(fault_after([&] {
              write_file(folder_ / "other", content);
              fs::rename(folder_ / "other", file());
            }).find("was replaced by another file while it was followed"),
            std::string::npos);
  const std::string shorter = fault_after([&] { fs::resize_file(file(), 100); });
  EXPECT_TRUE(shorter.find("became shorter while it was followed") != std::string::npos ||
              shorter.find("the file ends at byte ") != std::string::npos)  // within a scan
      << shorter;
}

TEST_F(FollowedBagTest, NothingIsKeptOfAStreamBeforeItsFirstCloud) {
  std::vector<Message> messages;
  for (int k = 0; k < 40; ++k) {
    messages.push_back({3, at_ns(-5.0 + 0.1 * k), std::string(1'000'000, 'i')});
  }
  const std::size_t before = messages.size();
  const std::vector<Message> rest = drive();
  messages.insert(messages.end(), rest.begin(), rest.end());
  const std::string content = by_hand::mcap_file(channels_of_drive(), messages, layout_of("unchunked"));
  const Followed followed = follow_stream(content);
  EXPECT_EQ(followed.fault, "");
  expect_as_finished(followed.scans, content);

  std::array<int, 2> ends = {};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::thread writer([&, end = ends[1]] {
    messages.resize(before);
    const std::string cut = by_hand::mcap_file(channels_of_drive(), messages, layout_of("unchunked"));
    for (std::size_t at = 0; at < cut.size();) {
      const ::ssize_t written = ::write(end, cut.data() + at, std::min<std::size_t>(100'000, cut.size() - at));
      ASSERT_GT(written, 0);
      at += static_cast<std::size_t>(written);
    }
    ::close(end);
  });
  bags::FollowedMcap mcap(bags::growing_stream(ends[0], "a stream"));
  mcap.keep_only([](const bags::Topic& topic) { return topic.name == "/lidar"; });
  while (!mcap.is_over()) {
    mcap.advance(std::chrono::milliseconds(20), 1);
    mcap.forget_before_new();
  }
  writer.join();
  ::close(ends[0]);
  EXPECT_EQ(mcap.come(), 0U);
  EXPECT_LT(mcap.kept(), 4'000'000U) << "of 40 MB: the last blocks";
}

TEST_F(FollowedBagTest, WaitingEndsWhenItIsToStopOrNothingComes) {
  const std::string content = by_hand::mcap_file(channels_of_drive(), drive(), layout_of("none"));
  write_file(file(), content.substr(0, 40));
  EXPECT_EQ(follow_input(file(), {}, {.count = kOpenedWith}, [] { return true; }), nullptr);
  const FirstScans soon = {.count = kOpenedWith, .longest_silence = std::chrono::milliseconds(60)};
  EXPECT_THROW(follow_input(file(), {}, soon, never), DataError);
}

TEST_F(FollowedBagTest, WhatCannotBeFollowedIsRefused) {
  const auto refusal = [&](const fs::path& name, const std::string& content) -> std::string {
    write_file(folder_ / name, content);
    try {
      follow_input(folder_ / name, {}, {.count = 1}, [] { return true; });
    } catch (const UsageError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_NE(refusal("a.bag", by_hand::ros1_bag({}, {})).find("it is a ROS 1 bag"), std::string::npos);
  EXPECT_NE(refusal("a.db3", std::string("SQLite format 3\0", 16)).find("a database of ROS 2"), std::string::npos);
  EXPECT_NE(refusal("a.txt", "words").find("cannot be followed"), std::string::npos);
  fs::create_directories(folder_ / "rosbag2");
  write_file(folder_ / "rosbag2" / "a.mcap", by_hand::mcap_file(channels_of_drive(), drive()));
  EXPECT_THROW(follow_input(folder_ / "rosbag2", {}, {}, never), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::datasets
