// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/followed_folder.hpp"

#include <thread>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/read_ahead.hpp"

#include "testing/recording_by_hand.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class FollowedFolderTest : public benchmark::FolderTest {
 protected:
  [[nodiscard]] fs::path scan_file(int number) const {
    return folder_ / "point_clouds" / ("0000" + std::to_string(number) + ".bin");
  }
  /// Scan `number`, with as many points.
  void write_scan(int number) const {
    std::string bytes;
    for (int k = 0; k < number; ++k) {
      bytes += floats({1.0F, 2.0F, 3.0F, 0.5F});
    }
    write_file(scan_file(number), bytes);
  }
  static bool never() { return false; }
};

TEST_F(FollowedFolderTest, WaitsForScansUntilTheyAreWhole) {
  write_scan(1);
  write_scan(2);
  const auto followed = follow_folder(folder_, {});
  ASSERT_TRUE(followed->wait_for(0, never));
  std::thread writer([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const std::string half = floats({1.0F, 2.0F});
    write_file(scan_file(3), half);  // as long as somebody writes, nobody reads
    for (int k = 0; k < 5; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      write_file(scan_file(3), half);
    }
    write_scan(3);
  });
  ASSERT_TRUE(followed->wait_for(2, never));
  writer.join();
  EXPECT_EQ(followed->scan(2).points.size(), 3U);
  EXPECT_TRUE(followed->arrival(2));
  EXPECT_LE(*followed->arrival(2), std::chrono::steady_clock::now());
}

/// How far the clock of whoever writes is ahead.
class FollowedFolderClockTest : public FollowedFolderTest, public testing::WithParamInterface<std::chrono::hours> {};

TEST_P(FollowedFolderClockTest, TheClockOfWhoWritesMayJump) {
  using std::chrono::steady_clock;
  write_scan(1);
  const auto followed = follow_folder(folder_, {});
  steady_clock::time_point written;  // about
  std::thread writer([&] {
    for (int k = 0; k < 6; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      written = steady_clock::now();
      write_file(scan_file(2), k < 5 ? floats({1.0F, 2.0F}) : floats({1.0F, 2.0F, 3.0F, 0.5F}));
      fs::last_write_time(scan_file(2), fs::file_time_type::clock::now() + GetParam());
    }
  });
  const steady_clock::time_point latest = steady_clock::now() + std::chrono::seconds(20);
  const bool came = followed->wait_for(1, [&] { return steady_clock::now() > latest; });
  const steady_clock::time_point seen = steady_clock::now();
  writer.join();
  ASSERT_TRUE(came);
  EXPECT_EQ(followed->scan(1).points.size(), 1U) << "as long as somebody writes, nobody reads";
  ASSERT_TRUE(followed->arrival(1));
  EXPECT_GE(*followed->arrival(1), written - std::chrono::seconds(1));
  EXPECT_LE(*followed->arrival(1), seen);
}

INSTANTIATE_TEST_SUITE_P(Hours, FollowedFolderClockTest,
                         testing::Values(std::chrono::hours(-1), std::chrono::hours(0), std::chrono::hours(1)));

TEST_F(FollowedFolderTest, ALaterFileMakesAnEarlierOneWhole) {
  const auto followed = follow_folder(folder_, {});
  EXPECT_EQ(followed->size(), 0U) << "an empty folder may get scans";
  std::thread writer([this] {
    for (int number = 1; number <= 5; ++number) {
      write_scan(number);
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  });
  ReadAhead reader(*followed, 0, 5);
  for (std::size_t points = 1; points <= 5; ++points) {
    ASSERT_FALSE(reader.done());
    EXPECT_EQ(reader.next().points.size(), points);
  }
  EXPECT_TRUE(reader.done());
  writer.join();
}

TEST_F(FollowedFolderTest, WaitingEndsWhenItIsToStop) {
  write_scan(1);
  write_scan(2);
  const auto followed = follow_folder(folder_, {});
  ReadAhead reader(*followed, 0, 100);
  EXPECT_EQ(reader.next().points.size(), 1U);
  EXPECT_EQ(reader.next().points.size(), 2U);
  EXPECT_FALSE(reader.wait(std::chrono::milliseconds(50)));
  reader.stop();
  EXPECT_TRUE(reader.done());
  EXPECT_EQ(follow_input(folder_, {}, {.count = 9}, [] { return true; }), nullptr);
}

TEST_F(FollowedFolderTest, ScansThatWereReadMustStay) {
  write_scan(4);
  write_scan(5);
  const auto followed = follow_folder(folder_, {});
  ASSERT_TRUE(followed->wait_for(1, never));
  write_scan(1);  // all others move on by one
  EXPECT_THROW(followed->wait_for(2, never), DataError);
}

TEST_F(FollowedFolderTest, AFolderThatIsNotThereIsAnErrorAtOnce) {
  EXPECT_THROW(follow_folder(folder_ / "missing", {}), DataError);
  write_scan(1);
  EXPECT_THROW(follow_input(scan_file(1), {}, {}, never), UsageError);
  InputSettings settings;
  settings.open.format = "nonsense";
  EXPECT_THROW(follow_folder(folder_, settings), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::datasets
