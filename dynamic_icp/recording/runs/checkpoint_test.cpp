// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/checkpoint.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::runs {
namespace {

TEST(Checkpoint, IsReadAsItWasWrittenOrNotAtAll) {
  const TestFolder folder;
  Checkpoint checkpoint{"{}", "run drive", 17, 99, std::string(1000, 'o'), std::string("r\0s", 3)};
  write_checkpoint(folder.path(), checkpoint);
  const Checkpoint back = read_checkpoint(folder.path());
  EXPECT_EQ(back.identity, "{}");
  EXPECT_EQ(back.command, "run drive");
  EXPECT_EQ(back.next, 17U);
  EXPECT_EQ(back.last_scan, 99U);
  EXPECT_EQ(back.odometry, checkpoint.odometry);
  EXPECT_EQ(back.results, checkpoint.results);
  const std::filesystem::path file = folder.path() / kCheckpointFile;
  const std::string bytes = formats::read_whole_file(file);
  for (std::size_t length = 0; length < bytes.size(); length += 97) {
    std::filesystem::resize_file(file, length);
    EXPECT_THROW(read_checkpoint(folder.path()), DataError) << length;
    formats::write_whole_file(file, bytes);
  }
}

TEST(Checkpoint, DifferencesAreNamed) {
  const std::string one =
      R"({"method":"gicp","input":{"path":"/a","options":{}},"configuration":{"a.b":0.5,"c":true}})";
  EXPECT_EQ(difference(one, one), std::nullopt);
  EXPECT_EQ(difference(one, R"({"method":"kiss-icp"})"), R"(method was "gicp" and is "kiss-icp" now)");
  EXPECT_EQ(difference(one, R"({"method":"kiss-icp","configuration":{"other":1}})"),
            R"(method was "gicp" and is "kiss-icp" now)")
      << "the first as written";
  EXPECT_EQ(difference(one, R"({"input":{"path":"/b","options":{}}})"), R"(input.path was "/a" and is "/b" now)");
  EXPECT_EQ(difference(one, R"({"configuration":{"a.b":0.25,"c":true}})"), "a.b was 0.5 and is 0.25 now");
  EXPECT_EQ(difference(one, R"({"input":{"path":"/a","options":{"topic":"x"}}})"),
            R"(input.options.topic was null and is "x" now)");
  EXPECT_EQ(difference(R"({"input":{"path":"/a","options":{"topic":"x"}}})", R"({"input":{"path":"/a","options":{}}})"),
            R"(input.options.topic was "x" and is null now)");
  EXPECT_EQ(difference(one, R"({"save_labels":true})"), std::nullopt) << "what only one of them tells";
}

TEST(Checkpoint, EveryColumnOfAScanCounts) {
  RawScan scan;
  scan.points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  scan.doppler = {0.5, 0.25};
  const std::uint64_t sum = checksum(scan);
  EXPECT_EQ(checksum(scan), sum);
  RawScan other = scan;
  other.points[1].x() += 1e-15;
  EXPECT_NE(checksum(other), sum);
  other = scan;
  other.doppler[0] = -0.5;
  EXPECT_NE(checksum(other), sum);
  other = scan;
  other.times = {0.0, 0.0};
  EXPECT_NE(checksum(other), sum);
  other = scan;
  other.stamp.ns = 1;
  EXPECT_NE(checksum(other), sum);
}

TEST(CheckpointTimer, IsDueAfterItsInterval) {
  EXPECT_TRUE(CheckpointTimer(0.0).is_due());
  EXPECT_FALSE(CheckpointTimer(3600.0).is_due());
}

}  // namespace
}  // namespace dynamic_icp::runs
