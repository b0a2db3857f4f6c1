// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/bag.hpp"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/bag_contents.hpp"
#include "testing/bags_by_hand.hpp"
#include "testing/db3_by_hand.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;
using by_hand::Channel;
using by_hand::Message;

const std::vector<Channel> kPartChannels = {{1, "/points", "sensor_msgs/msg/PointCloud2", "uint8[] data", "cdr"},
                                            {2, "/tf_static", "tf2_msgs/msg/TFMessage", "x", "cdr"}};

class Bags : public benchmark::FolderTest {
 protected:
  /// Three messages from a time on.
  static std::vector<Message> messages(std::int64_t from) {
    return {{1, from, "a"}, {1, from + 10, "b"}, {1, from + 20, "c"}};
  }
  fs::path make_mcap(const std::string& name, std::int64_t from, const std::vector<Channel>& channels = kPartChannels) {
    write_file(folder_ / name, by_hand::mcap_file(channels, messages(from)));
    return folder_ / name;
  }
  fs::path make_bag(const std::string& name, std::int64_t from) {
    write_file(folder_ / name, by_hand::ros1_bag(kPartChannels, messages(from)));
    return folder_ / name;
  }
  static std::string content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write_metadata(const std::string& folder, const std::string& lines) {
    write_file(folder_ / folder / "metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n" + lines);
  }
  static std::vector<std::int64_t> times_of(const Bag& bag) {
    std::vector<std::int64_t> times;
    for (const SeenMessage& message : messages_of(bag)) {
      times.push_back(message.time_ns);
    }
    return times;
  }
  [[nodiscard]] std::string finding_error(const std::string& container = "") const {
    try {
      find_bag(folder_, container);
    } catch (const DataError& error) {
      return error.what();
    }
    return {};
  }
  static std::string opening_error(const fs::path& path) {
    try {
      open_bag(path);
    } catch (const DataError& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(Bags, AreFoundUpToThreeLevelsBelow) {
  EXPECT_EQ(find_bag(folder_, ""), fs::path());
  EXPECT_EQ(find_bag(folder_ / "missing", ""), fs::path());
  const fs::path deep = make_bag("1/2/3/4/a.bag", 1);
  EXPECT_EQ(find_bag(folder_, ""), fs::path());
  EXPECT_EQ(find_bag(folder_ / "1", ""), deep);
  EXPECT_EQ(find_bag(folder_ / "1", "rosbag"), deep);
  EXPECT_EQ(find_bag(folder_ / "1", "mcap"), fs::path());
  write_file(folder_ / "1/notes.bag", "of another kind");
  EXPECT_EQ(find_bag(folder_ / "1", ""), deep);
  write_file(folder_ / "1/text", "of another kind");
  EXPECT_EQ(find_bag(folder_ / "1/text", ""), fs::path());
}

TEST_F(Bags, SeveralMustBeNamed) {
  const fs::path first = make_bag("a/drive.bag", 1);
  const fs::path second = make_mcap("b/drive.mcap", 1);
  EXPECT_EQ(finding_error(), folder_.string() + ": holds several recordings, name one of them:\n  " + first.string() +
                                 "\n  " + second.string());
  EXPECT_EQ(find_bag(folder_, "rosbag"), first);
  EXPECT_EQ(find_bag(folder_, "mcap"), second);
  EXPECT_EQ(find_bag(folder_, "rosbag2"), fs::path());
}

TEST_F(Bags, OfTwoKindsInOneFolderMustBeNamed) {
  const fs::path first = make_bag("drive.bag", 1);
  const fs::path second = make_mcap("drive.mcap", 1);
  EXPECT_NE(finding_error().find("name one of them"), std::string::npos);
  EXPECT_EQ(find_bag(folder_, "rosbag"), first);
  EXPECT_EQ(find_bag(folder_, "mcap"), second);
}

TEST_F(Bags, PartsOfARecordingAreOneInTheOrderOfTime) {
  make_mcap("drive_0.mcap", 200);
  make_mcap("drive_1.mcap", 100);
  // Only one part of a recording has what is sent once.
  make_mcap("drive_10.mcap", 300, {kPartChannels.front()});
  ASSERT_EQ(find_bag(folder_, ""), folder_);
  const std::unique_ptr<Bag> bag = open_bag(folder_);
  EXPECT_EQ(bag->container(), "mcap");
  ASSERT_EQ(bag->topics().size(), 2U);
  EXPECT_EQ(bag->topics()[0].messages, 9U);
  EXPECT_EQ(times_of(*bag), (std::vector<std::int64_t>{100, 110, 120, 200, 210, 220, 300, 310, 320}));
  EXPECT_EQ(bag->file(bag->messages({{0}}).front()), folder_ / "drive_1.mcap");
  ASSERT_EQ(bag->notes().size(), 1U);
  EXPECT_EQ(bag->notes()[0], folder_.string() + ": 3 files are read as one recording");
}

TEST_F(Bags, ThatAreNoPartsOfOneRecordingAreListed) {
  make_mcap("a.mcap", 100);
  make_mcap("b.mcap", 200, {{1, "/other", "sensor_msgs/msg/PointCloud2", "uint8[] data", "cdr"}});
  EXPECT_EQ(opening_error(folder_), folder_.string() +
                                        ": holds several recordings (they do not hold the same topics), name one of "
                                        "them:\n  " +
                                        (folder_ / "a.mcap").string() + "\n  " + (folder_ / "b.mcap").string());
}

TEST_F(Bags, OfTheSameTimeAreNoPartsOfOneRecording) {
  make_bag("drive.bag", 100);
  make_bag("drive.orig.bag", 100);  // as 'rosbag reindex' leaves
  EXPECT_NE(opening_error(folder_).find("drive.bag and drive.orig.bag are of the same time"), std::string::npos)
      << opening_error(folder_);
}

TEST_F(Bags, OfOldVersionsAreRefusedWithAWayOut) {
  write_file(folder_ / "old.bag", "#ROSBAG V1.2\n....");
  ASSERT_EQ(find_bag(folder_, ""), folder_ / "old.bag");
  EXPECT_NE(opening_error(folder_ / "old.bag").find("old.bag: is a ROS bag from before version 2.0; "),
            std::string::npos);
}

TEST_F(Bags, OfRos2HaveMetadata) {
  by_hand::write_db3(folder_ / "drive/drive_0.db3", kPartChannels, messages(100));
  by_hand::write_db3(folder_ / "drive/drive_1.db3", kPartChannels, messages(200));
  by_hand::write_db3(folder_ / "drive/left_out.db3", kPartChannels, messages(100));
  write_metadata("drive", "  relative_file_paths:\n    - drive/drive_0.db3\n    - drive/drive_1.db3\n");
  ASSERT_EQ(find_bag(folder_, ""), folder_ / "drive");
  ASSERT_EQ(find_bag(folder_, "rosbag2"), folder_ / "drive");
  const std::unique_ptr<Bag> bag = open_bag(folder_ / "drive");
  EXPECT_EQ(bag->container(), "rosbag2");
  EXPECT_EQ(times_of(*bag), (std::vector<std::int64_t>{100, 110, 120, 200, 210, 220}));
  EXPECT_TRUE(bag->notes().empty());
}

TEST_F(Bags, OfRos2MayLieInMcapFiles) {
  make_mcap("drive/drive_0.mcap", 100);
  write_metadata("drive", "  storage_identifier: mcap\n  relative_file_paths: [drive_0.mcap, drive_1.mcap]\n");
  const std::unique_ptr<Bag> bag = open_bag(find_bag(folder_, ""));
  EXPECT_EQ(bag->container(), "rosbag2");
  EXPECT_EQ(times_of(*bag), (std::vector<std::int64_t>{100, 110, 120}));
  ASSERT_EQ(bag->notes().size(), 1U);
  EXPECT_NE(bag->notes()[0].find("drive_1.mcap: is missing"), std::string::npos) << bag->notes()[0];
}

TEST_F(Bags, OfRos2AreReadWithoutMetadata) {
  by_hand::write_db3(folder_ / "a_0.db3", kPartChannels, messages(100));
  by_hand::write_db3(folder_ / "a_1.db3", kPartChannels, messages(200));
  EXPECT_EQ(times_of(*open_bag(find_bag(folder_, ""))), (std::vector<std::int64_t>{100, 110, 120, 200, 210, 220}));
  write_metadata(".", "  relative_file_paths: 7\n");
  const std::unique_ptr<Bag> bag = open_bag(find_bag(folder_, ""));
  EXPECT_EQ(times_of(*bag), (std::vector<std::int64_t>{100, 110, 120, 200, 210, 220}));
  EXPECT_NE(bag->notes().front().find("metadata.yaml: expected"), std::string::npos) << bag->notes().front();
}

TEST_F(Bags, OfRos2MayBePackedAsFiles) {
  by_hand::write_db3(folder_ / "plain/a.db3", kPartChannels, messages(100));
  write_file(folder_ / "drive/a.db3.zstd", by_hand::packed("zstd", content_of(folder_ / "plain/a.db3")));
  write_file(folder_ / "drive/b.mcap.zstd", by_hand::packed("zstd", by_hand::mcap_file(kPartChannels, messages(200))));
  write_metadata("drive",
                 "  relative_file_paths: [a.db3.zstd, b.mcap.zstd]\n  compression_format: zstd\n"
                 "  compression_mode: FILE\n");
  const std::unique_ptr<Bag> bag = open_bag(folder_ / "drive");
  EXPECT_EQ(times_of(*bag), (std::vector<std::int64_t>{100, 110, 120, 200, 210, 220}));
  EXPECT_EQ(bag->file(bag->messages({{0}}).front()), folder_ / "drive/a.db3.zstd");
  EXPECT_EQ(find_bag(folder_ / "drive/a.db3.zstd", ""), folder_ / "drive/a.db3.zstd");
  EXPECT_EQ(times_of(*open_bag(folder_ / "drive/b.mcap.zstd")), (std::vector<std::int64_t>{200, 210, 220}));
}

TEST_F(Bags, ThatWereUnpackedLeaveNothing) {
  ASSERT_EQ(::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1), 0);
  fs::create_directories(folder_ / "tmp");
  write_file(folder_ / "a.mcap.zstd", by_hand::packed("zstd", by_hand::mcap_file(kPartChannels, messages(200))));
  write_file(folder_ / "b.mcap.zstd", by_hand::packed("zstd", "no bag"));
  {
    const std::unique_ptr<Bag> bag = open_bag(folder_ / "a.mcap.zstd");
    EXPECT_FALSE(fs::is_empty(folder_ / "tmp"));
  }
  EXPECT_NE(opening_error(folder_ / "b.mcap.zstd").find("b.mcap.zstd: expected a ROS 1 bag"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder_ / "tmp"));
  ::unsetenv("TMPDIR");
}

TEST_F(Bags, ThatArePackedAreReadUpToWhereTheyAreCutOrDamaged) {
  std::vector<Message> many;
  std::uint32_t random = 1;
  for (int k = 0; k < 100; ++k) {
    std::string noise(4000, '\0');
    for (char& byte : noise) {
      random = random * 1664525U + 1013904223U;
      byte = static_cast<char>(random >> 24U);
    }
    many.push_back({1, 100 + k, noise});
  }
  const std::string whole = by_hand::packed("zstd", by_hand::mcap_file(kPartChannels, many));
  std::size_t most = 0;
  for (std::size_t part = 0; part < 50; ++part) {
    for (const bool is_cut : {true, false}) {
      const std::size_t at = whole.size() * part / 50;
      std::string content = is_cut ? whole.substr(0, at) : whole;
      if (!is_cut) {
        content[at] = static_cast<char>(~content[at]);
      }
      fs::remove(folder_ / "a.mcap.zstd");
      write_file(folder_ / "a.mcap.zstd", content);
      try {
        const std::unique_ptr<Bag> bag = open_bag(folder_ / "a.mcap.zstd");
        const std::vector<SeenMessage> seen = messages_of(*bag);
        most = std::max(most, seen.size());
        for (std::size_t k = 0; k < seen.size(); ++k) {
          EXPECT_TRUE(seen[k].data == many[k].data) << at;
        }
        EXPECT_TRUE(seen.size() == many.size() || !bag->notes().empty()) << at;
      } catch (const DataError& error) {
        EXPECT_NE(std::string(error.what()).find("a.mcap.zstd: "), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(most, many.size() / 2);
}

TEST_F(Bags, OfRos2MayBePackedMessageByMessage) {
  std::vector<Message> packed = messages(100);
  for (Message& message : packed) {
    message.data = by_hand::packed("zstd", message.data + std::string(1000, 'x'));
  }
  packed.push_back({1, 500, "not packed"});
  by_hand::write_db3(folder_ / "drive/a.db3", kPartChannels, packed);
  write_metadata("drive", "  relative_file_paths: [a.db3]\n  compression_format: zstd\n  compression_mode: MESSAGE\n");
  const std::unique_ptr<Bag> bag = open_bag(folder_ / "drive");
  const std::vector<MessageEntry> entries = bag->messages({{0}});
  ASSERT_EQ(entries.size(), 4U);
  EXPECT_EQ(bag->read(entries[1]), "b" + std::string(1000, 'x'));
  try {
    (void)bag->read(entries[3]);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("a.db3: a message of /points: the Zstandard data are damaged"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::bags
