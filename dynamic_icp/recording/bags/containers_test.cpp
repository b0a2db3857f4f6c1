// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What holds for every container: files put together by the formats' specifications.
#include <algorithm>
#include <functional>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/file_bag.hpp"

#include "testing/bag_contents.hpp"
#include "testing/bags_by_hand.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;
using by_hand::Channel;
using by_hand::Layout;
using by_hand::Message;

constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;

const std::vector<Channel>& channels() {
  static const std::vector<Channel> all = {{7, "/points", "sensor_msgs/PointCloud2", "Header header\nuint8[] data"},
                                           {3, "/imu", "sensor_msgs/Imu", "Header header"},
                                           {4, "/empty", "sensor_msgs/Imu", "Header header"}};
  return all;
}

/// Of several sizes, not in the order of time, some that pack well and some that do not.
std::vector<Message> some_messages() {
  std::vector<Message> messages;
  std::uint32_t random = 1;
  for (int k = 0; k < 11; ++k) {
    std::string data(static_cast<std::size_t>(k * 37 % 400), static_cast<char>('a' + k));
    for (std::size_t i = 0; i < data.size() && k % 2 == 0; ++i) {
      random = random * 1664525U + 1013904223U;
      data[i] = static_cast<char>(random >> 24U);
    }
    messages.push_back(
        {static_cast<std::uint16_t>(k % 3 == 0 ? 7 : 3), kBegin + (k == 5 ? 0 : k) * 100'000'007LL, data});
  }
  return messages;
}

struct Case {
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

  std::string name;
  std::string container;
  Layout layout;
  bool is_looked_through = false;  ///< a note must say so

  [[nodiscard]] std::string file(const std::vector<Message>& messages) const {
    return container == "rosbag" ? by_hand::ros1_bag(channels(), messages, layout)
                                 : by_hand::mcap_file(channels(), messages, layout);
  }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* const compression : {"none", "bz2", "lz4"}) {
    Layout layout;
    layout.compression = compression;
    cases.push_back({std::string("rosbag_") + compression, "rosbag", layout});
    layout.has_index = false;
    cases.push_back({std::string("rosbag_not_closed_") + compression, "rosbag", layout, true});
  }
  for (const char* const compression : {"none", "lz4", "zstd"}) {
    Layout layout;
    layout.compression = compression;
    cases.push_back({std::string("mcap_") + compression, "mcap", layout});
    layout.has_crc = false;
    cases.push_back({std::string("mcap_without_crc_") + compression, "mcap", layout});
    layout.has_message_index = false;
    cases.push_back({std::string("mcap_without_message_index_") + compression, "mcap", layout});
    layout.has_statistics = false;
    cases.push_back({std::string("mcap_without_statistics_") + compression, "mcap", layout, true});
    layout.has_index = false;
    cases.push_back({std::string("mcap_without_summary_") + compression, "mcap", layout, true});
  }
  Layout layout;
  layout.repeats_channels = false;
  cases.push_back({"mcap_without_channels_in_summary", "mcap", layout, true});
  layout = {};
  layout.is_chunked = false;
  cases.push_back({"mcap_without_chunks", "mcap", layout, true});
  return cases;
}

class Containers : public benchmark::FolderTest, public ::testing::WithParamInterface<Case> {
 protected:
  std::unique_ptr<Bag> open(const std::string& content) {
    const fs::path path = folder_ / "of any name";
    write_file(path, content);
    EXPECT_EQ(find_bag(path, ""), path);
    EXPECT_EQ(find_bag(path, GetParam().container), path);
    return open_bag(path);
  }

  static std::vector<SeenMessage> expected(std::vector<Message> messages, const std::string& topic = "") {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const Message& a, const Message& b) { return a.time_ns < b.time_ns; });
    std::vector<SeenMessage> seen;
    for (const Message& message : messages) {
      const std::string name = message.channel == 7 ? "/points" : "/imu";
      if (topic.empty() || topic == name) {
        seen.push_back({name, message.time_ns, message.data});
      }
    }
    return seen;
  }
};

TEST_P(Containers, HoldTopicsAndMessages) {
  const std::vector<Message> messages = some_messages();
  const std::unique_ptr<Bag> bag = open(GetParam().file(messages));
  EXPECT_EQ(bag->container(), GetParam().container);
  ASSERT_EQ(bag->topics().size(), 3U);
  const Topic& points = bag->topics()[2];
  EXPECT_EQ(bag->topics()[0].name, "/empty");
  EXPECT_EQ(bag->topics()[0].messages, 0U);
  EXPECT_EQ(bag->topics()[1].name, "/imu");
  EXPECT_EQ(bag->topics()[1].messages, 7U);
  EXPECT_EQ(points.name, "/points");
  EXPECT_EQ(points.messages, 4U);
  EXPECT_EQ(points.type, "sensor_msgs/PointCloud2");
  EXPECT_EQ(points.encoding, GetParam().container == "rosbag" ? Encoding::kRos1 : Encoding::kCdr);
  EXPECT_EQ(points.encoding_name, GetParam().container == "rosbag" ? "ros1" : "cdr");
  EXPECT_EQ(points.schema, "Header header\nuint8[] data");
  EXPECT_EQ(messages_of(*bag), expected(messages));
  EXPECT_EQ(messages_of(*bag, {2}), expected(messages, "/points"));
  EXPECT_EQ(messages_of(*bag, {1}), expected(messages, "/imu"));
  EXPECT_TRUE(messages_of(*bag, {0}).empty());
  EXPECT_TRUE(messages_of(*bag, {}).empty());
  EXPECT_EQ(bag->notes().size(), GetParam().is_looked_through ? 1U : 0U) << bag->notes().front();
  for (const std::string& note : bag->notes()) {
    EXPECT_NE(note.find("of any name: no index ("), std::string::npos) << note;
  }
}

TEST_P(Containers, MayHoldNothing) {
  const std::unique_ptr<Bag> bag = open(GetParam().file({}));
  EXPECT_TRUE(messages_of(*bag).empty());
}

TEST_P(Containers, AreReadByThreads) {
  const std::vector<Message> messages = some_messages();
  const std::unique_ptr<Bag> bag = open(GetParam().file(messages));
  std::vector<std::vector<SeenMessage>> seen(4);
  {
    std::vector<std::jthread> threads;
    for (auto& own : seen) {
      threads.emplace_back([&] { own = messages_of(*bag); });
    }
  }
  for (const auto& own : seen) {
    EXPECT_EQ(own, expected(messages));
  }
}

/// Cut anywhere: what is left is the begin, and said so.
TEST_P(Containers, AreReadUpToWhereTheyAreCut) {
  const std::vector<Message> messages = some_messages();
  const std::string whole = GetParam().file(messages);
  std::vector<SeenMessage> written;
  for (const Message& message : messages) {
    written.push_back({message.channel == 7 ? "/points" : "/imu", message.time_ns, message.data});
  }
  std::size_t most = 0;
  for (std::size_t part = 0; part < 50; ++part) {
    const std::size_t size = whole.size() * part / 50;
    try {
      fs::remove(folder_ / "cut");  // to write a file anew over one that is there takes some systems long
      write_file(folder_ / "cut", whole.substr(0, size));
      const std::unique_ptr<Bag> bag = open_bag(folder_ / "cut");
      std::vector<SeenMessage> seen = messages_of(*bag);
      most = std::max(most, seen.size());
      std::vector<SeenMessage> begin(written.begin(), written.begin() + static_cast<std::ptrdiff_t>(seen.size()));
      std::stable_sort(begin.begin(), begin.end(), [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
      EXPECT_EQ(seen, begin) << size;
      EXPECT_FALSE(bag->notes().empty()) << size;
      // Between two records nothing more can be said than that the end is missing.
      const std::string& note = bag->notes().back();
      EXPECT_TRUE(note.find(std::to_string(seen.size()) + " messages before it are left") != std::string::npos ||
                  note.find("the end is missing") != std::string::npos ||
                  note.find("the recording was not closed") != std::string::npos || size > whole.size() / 2)
          << note;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find("cut: "), std::string::npos) << error.what();
    }
  }
  EXPECT_GE(most, 6U) << "messages of a bag that is nearly whole";
}

/// Damaged anywhere: a sentence, or messages; of those with a checksum the right ones.
TEST_P(Containers, AreReadOrRefusedWhereTheyAreDamaged) {
  const std::vector<Message> messages = some_messages();
  const std::string whole = GetParam().file(messages);
  std::set<std::pair<std::int64_t, std::string>> written;
  for (const Message& message : messages) {
    written.emplace(message.time_ns, message.data);
  }
  const Layout& layout = GetParam().layout;
  const bool has_checksum =
      GetParam().container == "mcap" ? layout.has_crc && layout.is_chunked : layout.compression == "bz2";
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 100) {
    for (const int change : {0x01, 0xFF}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      fs::remove(folder_ / "damaged");
      write_file(folder_ / "damaged", damaged);
      try {
        const std::unique_ptr<Bag> bag = open_bag(folder_ / "damaged");
        for (const MessageEntry& entry : bag->messages(all_topics(*bag))) {
          try {
            const std::string data = bag->read(entry);
            EXPECT_TRUE(!has_checksum || written.contains({entry.recorded_ns, data})) << at;
          } catch (const DataError& error) {
            EXPECT_NE(std::string(error.what()).find("damaged: "), std::string::npos) << error.what();
          }
        }
      } catch (const DataError& error) {
        EXPECT_NE(std::string(error.what()).find("damaged: "), std::string::npos) << error.what();
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Containers, ::testing::ValuesIn(all_cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST(PlainType, IsTheSameByAnyWritersSpelling) {
  EXPECT_EQ(plain_type("sensor_msgs/PointCloud2"), "sensor_msgs/PointCloud2");
  EXPECT_EQ(plain_type("sensor_msgs/msg/PointCloud2"), "sensor_msgs/PointCloud2");
  EXPECT_EQ(plain_type("sensor_msgs::msg::dds_::PointCloud2_"), "sensor_msgs/PointCloud2");
  EXPECT_EQ(plain_type("foxglove::PointCloud"), "foxglove.PointCloud");
  EXPECT_EQ(plain_type("foxglove.PointCloud"), "foxglove.PointCloud");
  EXPECT_EQ(plain_type(""), "");
}

}  // namespace
}  // namespace dynamic_icp::bags
