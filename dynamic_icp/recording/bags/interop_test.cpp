// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Bags written by other programs, with the scripts of tests/interop.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/bags/bag.hpp"

#include "testing/bag_contents.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;

const fs::path kScripts = DYNAMIC_ICP_INTEROP_FOLDER;

class OtherWriters : public benchmark::FolderTest {
 protected:
  /// Whether the program is there; runs it quietly.
  static bool runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

  void write(const std::string& program, const std::string& script) {
    const std::string command = program + " '" + (kScripts / script).string() + "' '" + folder_.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream lines(folder_ / "messages.txt");
    for (std::string topic, type, encoding, time, data; lines >> topic >> type >> encoding >> time >> data;) {
      std::string bytes;
      for (std::size_t at = 2; at < data.size(); at += 2) {
        bytes += static_cast<char>(std::stoi(data.substr(at, 2), nullptr, 16));
      }
      written_.push_back({topic, std::stoll(time), bytes});
      if (const std::size_t msg = type.find("/msg/"); msg != std::string::npos) {
        type.erase(msg, 4);
      }
      topics_.emplace(topic, type, encoding);
    }
    ASSERT_GT(written_.size(), 50U);
    std::stable_sort(written_.begin(), written_.end(),
                     [](const SeenMessage& a, const SeenMessage& b) { return a.time_ns < b.time_ns; });
  }

  /// Every file of the folder but the list of messages. Where its name begins with "indexed" nothing is to be noted.
  void check_all(std::size_t expected_files, std::string_view container) {
    std::size_t files = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (entry.path().filename() == "messages.txt") {
        continue;
      }
      SCOPED_TRACE(entry.path().filename().string());
      ++files;
      ASSERT_EQ(find_bag(entry.path(), container), entry.path());
      const std::unique_ptr<Bag> bag = open_bag(entry.path());
      EXPECT_EQ(bag->container(), container);
      std::set<std::tuple<std::string, std::string, std::string>> topics;
      for (const Topic& topic : bag->topics()) {
        topics.emplace(topic.name, topic.type, topic.encoding_name);
        EXPECT_FALSE(topic.schema.empty());
        EXPECT_NE(topic.encoding, Encoding::kUnknown);
        EXPECT_EQ(topic.messages,
                  static_cast<std::uint64_t>(std::count_if(
                      written_.begin(), written_.end(), [&](const SeenMessage& m) { return m.topic == topic.name; })));
      }
      EXPECT_EQ(topics, topics_);
      EXPECT_EQ(messages_of(*bag), written_);
      for (const MessageEntry& message : bag->messages({{0}})) {
        const std::string whole = bag->read(message);
        const std::string front = bag->read_front(message, 100);
        EXPECT_GE(front.size(), std::min<std::size_t>(whole.size(), 100));
        EXPECT_EQ(front, whole.substr(0, front.size()));
      }
      const bool is_indexed = entry.path().filename().string().starts_with("indexed");
      const std::size_t parts = fs::is_directory(entry.path()) ? 2 : 1;
      EXPECT_EQ(bag->notes().empty(), is_indexed) << parts;
    }
    EXPECT_EQ(files, expected_files);
  }

  std::vector<SeenMessage> written_;  // by time
  std::set<std::tuple<std::string, std::string, std::string>> topics_;
};

TEST_F(OtherWriters, McapOfItsAuthors) {
  if (!fs::exists(kScripts / "node_modules/@mcap/core") || !runs("node --version")) {
    GTEST_SKIP() << "no @mcap/core: scripts/install_viewer.sh tests";
  }
  write("node", "write_mcap.mjs");
  check_all(7, "mcap");
}

TEST_F(OtherWriters, BagsOfRosbag) {
  if (!runs("/usr/bin/python3 -c 'import rosbag'")) {
    GTEST_SKIP() << "no rosbag: python3-rosbag of Debian";
  }
  write("/usr/bin/python3", "write_rosbag.py");
  check_all(4, "rosbag");
}

TEST_F(OtherWriters, DatabasesOfPython) {
  if (!runs("/usr/bin/python3 -c 'import sqlite3'")) {
    GTEST_SKIP() << "no Python";
  }
  write("/usr/bin/python3", "write_db3.py");
  check_all(1, "rosbag2");
}

}  // namespace
}  // namespace dynamic_icp::bags
