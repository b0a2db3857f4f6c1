// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"

#include "testing/bag_contents.hpp"
#include "testing/db3_by_hand.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;
using by_hand::Message;

const std::vector<by_hand::Channel> kDb3Channels = {{1, "/points", "sensor_msgs/msg/PointCloud2", "", "cdr"},
                                                    {2, "/imu", "sensor_msgs/msg/Imu", "", "cdr"}};
const std::vector<Message> kDb3Messages = {
    {1, 400, std::string(30000, 'p')}, {2, 200, "i2"}, {2, 100, std::string("\0\1", 2)}, {1, 300, ""}};
const std::vector<SeenMessage> kDb3Expected = {{"/imu", 100, std::string("\0\1", 2)},
                                               {"/imu", 200, "i2"},
                                               {"/points", 300, ""},
                                               {"/points", 400, std::string(30000, 'p')}};

class SqliteBag : public benchmark::FolderTest {
 protected:
  static std::string content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::string error_of(const fs::path& path) {
    try {
      const std::unique_ptr<Bag> bag = open_bag(path);
      (void)messages_of(*bag);
    } catch (const DataError& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(SqliteBag, HoldsTopicsAndMessages) {
  const fs::path path = folder_ / "100% odd?name#.db3";
  by_hand::write_db3(path, kDb3Channels, kDb3Messages);
  const std::string before = content_of(path);
  {
    const std::unique_ptr<Bag> bag = open_bag(path);
    EXPECT_EQ(bag->container(), "rosbag2");
    ASSERT_EQ(bag->topics().size(), 2U);
    EXPECT_EQ(bag->topics()[1].name, "/points");
    EXPECT_EQ(bag->topics()[1].type, "sensor_msgs/PointCloud2");
    EXPECT_EQ(bag->topics()[1].encoding, Encoding::kCdr);
    EXPECT_EQ(bag->topics()[1].messages, 2U);
    EXPECT_EQ(messages_of(*bag), kDb3Expected);
    EXPECT_TRUE(bag->notes().empty());
  }
  EXPECT_EQ(content_of(path), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "nothing is left beside it";
}

TEST_F(SqliteBag, IsReadWhereNobodyMayWrite) {
  by_hand::write_db3(folder_ / "locked/a.db3", kDb3Channels, kDb3Messages);
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(messages_of(*open_bag(folder_ / "locked/a.db3")), kDb3Expected);
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

TEST_F(SqliteBag, SaysWhatARecorderThatWasEndedLeft) {
  by_hand::write_db3(folder_ / "a.db3", kDb3Channels, kDb3Messages);
  write_file(folder_ / "a.db3-wal", "not empty");
  const std::unique_ptr<Bag> bag = open_bag(folder_ / "a.db3");
  ASSERT_EQ(bag->notes().size(), 1U);
  EXPECT_NE(bag->notes()[0].find("what stands only in a.db3-wal is not read"), std::string::npos) << bag->notes()[0];
  EXPECT_EQ(content_of(folder_ / "a.db3-wal"), "not empty");
}

TEST_F(SqliteBag, MayBeNoBag) {
  by_hand::execute(folder_ / "other.db3", "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT)");
  EXPECT_EQ(error_of(folder_ / "other.db3"),
            (folder_ / "other.db3").string() +
                ": is a database but no bag of ROS 2: there is no column 'type' in a table 'topics'");
  // What a table only seems to be could do anything.
  by_hand::execute(folder_ / "view.db3",
                   "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
                   "CREATE VIEW messages AS SELECT 1 AS id, 1 AS topic_id, 1 AS timestamp, 1 AS data");
  EXPECT_NE(error_of(folder_ / "view.db3"), "");
}

TEST_F(SqliteBag, IsReadOrRefusedWhereItIsCutOrDamaged) {
  by_hand::write_db3(folder_ / "a.db3", kDb3Channels, kDb3Messages);
  const std::string whole = content_of(folder_ / "a.db3");
  const auto check = [&](const std::string& content) {
    fs::remove(folder_ / "damaged.db3");
    write_file(folder_ / "damaged.db3", content);
    const std::string error = error_of(folder_ / "damaged.db3");
    EXPECT_TRUE(error.empty() || error.find("damaged.db3: ") != std::string::npos) << error;
    return error;
  };
  for (std::size_t part = 0; part < 50; ++part) {
    EXPECT_NE(check(whole.substr(0, whole.size() * part / 50)), "") << part;
  }
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 400) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0xFF);
    check(damaged);
  }
}

}  // namespace
}  // namespace dynamic_icp::bags
