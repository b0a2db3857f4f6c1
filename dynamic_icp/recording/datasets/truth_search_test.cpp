// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/truth_search.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class TruthSearch : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(above_); }

  static void write(const fs::path& path, int poses, double first_s) {
    std::string text;
    for (int i = 0; i < poses; ++i) {
      text += std::to_string(first_s + 0.1 * i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    }
    formats::write_whole_file(path, text);
  }
  Truth find(bool indices = false) {
    assumptions_.clear();
    return search_truth(folder_, stamps_, indices, assumptions_);
  }
  [[nodiscard]] bool said(const std::string& part) const {
    for (const std::string& sentence : assumptions_) {
      if (sentence.find(part) != std::string::npos) {
        return true;
      }
    }
    return false;
  }

  const std::vector<Stamp> stamps_ = {{1'000'000'000}, {1'100'000'000}, {1'200'000'000}, {1'300'000'000}};
  std::vector<std::string> assumptions_;
  fs::path above_ = fs::temp_directory_path() / ("truth_search_test-" + std::to_string(::getpid()));
  fs::path folder_ = above_ / "scans";
};

TEST_F(TruthSearch, WithoutFilesThereIsNothingToSay) {
  formats::write_whole_file(folder_ / "notes.txt", "1 2 3\n");
  EXPECT_TRUE(find().poses.empty());
  EXPECT_TRUE(assumptions_.empty());
}

TEST_F(TruthSearch, TakesWhatFitsByTime) {
  write(above_ / "example_gt.txt", 2, 1.05);
  const Truth truth = find();
  EXPECT_EQ(truth.poses.size(), 2u);
  EXPECT_EQ(truth.file.filename(), "example_gt.txt");
  EXPECT_TRUE(said("ground truth is taken from " + (above_ / "example_gt.txt").string()));
}

TEST_F(TruthSearch, LeavesWhatIsOfAnotherTimeAndSaysWhy) {
  write(folder_ / "gt.txt", 10, 100.0);
  EXPECT_TRUE(find().poses.empty());
  EXPECT_TRUE(said("0 of 4 scans are within 0.2 s"));
}

TEST_F(TruthSearch, ByNumberWhereStampsOnlyCount) {
  write(folder_ / "poses.txt", 4, 100.0);
  EXPECT_EQ(find(true).poses.size(), 4u);
  write(folder_ / "poses.txt", 5, 1.0);
  EXPECT_TRUE(find(true).poses.empty());
  EXPECT_TRUE(said("5 poses for 4 scans"));
}

TEST_F(TruthSearch, OfSeveralNoneIsTaken) {
  write(folder_ / "ground_truth.txt", 4, 1.0);
  write(folder_ / "ref_poses.txt", 4, 1.0);
  EXPECT_TRUE(find().poses.empty());
  EXPECT_TRUE(said("several files fit"));
  fs::rename(folder_ / "ref_poses.txt", above_ / "ref_poses.txt");
  EXPECT_EQ(find().file, folder_ / "ground_truth.txt") << "the nearer one";
  formats::write_whole_file(folder_ / "ground_truth.txt", "1 2 3 4 5 6 7 8 9 10 11 12\n");
  EXPECT_EQ(find().file, above_ / "ref_poses.txt");
  EXPECT_TRUE(said("no rotation"));
}

TEST_F(TruthSearch, PosesOfKittiOneForEachScanAndTablesWithNames) {
  std::string kitti;
  for (int i = 0; i < 4; ++i) {
    kitti += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  }
  formats::write_whole_file(folder_ / "poses.txt", kitti);
  const Truth by_count = find();
  ASSERT_EQ(by_count.poses.size(), 4u);
  EXPECT_EQ(by_count.poses[3].stamp, stamps_[3]);
  EXPECT_EQ(by_count.poses[3].T_world_sensor.translation().x(), 3.0);
  formats::write_whole_file(folder_ / "times.txt", "5\n6\n7\n8\n");
  EXPECT_TRUE(find().poses.empty()) << "they say another time";
  fs::remove(folder_ / "poses.txt");
  formats::write_whole_file(folder_ / "gt.csv",
                            "qw,qx,qy,qz,timestamp_ns,ty,tx,tz\n1,0,0,0,1000000000,2,1,3\n1,0,0,0,1300000000,5,4,6\n");
  const Truth table = find();
  ASSERT_EQ(table.poses.size(), 2u);
  EXPECT_EQ(table.poses[1].stamp.ns, 1'300'000'000);
  EXPECT_EQ(table.poses[1].T_world_sensor.translation(), Eigen::Vector3d(4, 5, 6));
}

TEST_F(TruthSearch, ASlashAtTheEndIsNoOtherFolder) {
  write(folder_ / "gt.txt", 4, 1.0);
  EXPECT_EQ(search_truth(folder_ / "", stamps_, false, assumptions_).poses.size(), 4u);
}

}  // namespace
}  // namespace dynamic_icp::datasets
