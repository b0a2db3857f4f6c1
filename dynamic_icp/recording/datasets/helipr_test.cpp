// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <limits>

#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

const std::string kLastOld = "LiDAR/Aeva/1691936557946849179.bin";
const std::string kFirstNew = "LiDAR/Aeva/1691936557946849180.bin";

/// Records of 25 bytes with numbers a scan may have.
std::string old_records(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    bytes += aeva_record(1.0F + static_cast<float>(i), 2, 3, -4.25F, 1000 * i).substr(0, 25);
  }
  return bytes;
}

std::string new_records(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    bytes += aeva_record(1.0F + static_cast<float>(i), 2, 3, -4.25F, 1000 * i);
  }
  return bytes;
}

using Helipr = RecordingByHand;

void expect_points(const Dataset& dataset, std::size_t index, std::size_t count) {
  const RawScan scan = dataset.scan(index);
  ASSERT_EQ(scan.points.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(scan.points[i], Eigen::Vector3d(1.0 + static_cast<double>(i), 2, 3));
    EXPECT_EQ(scan.doppler[i], -4.25);
    EXPECT_NEAR(scan.times[i], 1e-6 * static_cast<double>(i), 1e-12);
  }
}

TEST_F(Helipr, RecordsChangeWithTheStamp) {
  write(kLastOld, old_records(3));
  write(kFirstNew, new_records(4));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "helipr");
  ASSERT_EQ(dataset->size(), 2U);
  expect_points(*dataset, 0, 3);
  expect_points(*dataset, 1, 4);
  EXPECT_EQ(dataset->stamp(1).ns, 1'691'936'557'946'849'180);
  EXPECT_EQ(column(*dataset, 0, "line_index"), (std::vector<double>{7, 7, 7}));
  EXPECT_EQ(dataset->columns(0).size(), 2U) << "no intensity";
  EXPECT_EQ(column(*dataset, 1, "intensity"), (std::vector<double>{-57, -57, -57, -57}));
}

TEST_F(Helipr, ContentDecidesWhereTheSizeContradictsTheStamp) {
  write(kLastOld, new_records(3));
  write(kFirstNew, old_records(4));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  expect_points(*dataset, 0, 3);
  expect_points(*dataset, 1, 4);
}

TEST_F(Helipr, TheStampDecidesWhereTheSizeFitsBothOrNeither) {
  write(kFirstNew, new_records(25));  // 725 bytes: also 29 records of 25
  expect_points(*open_dataset(folder_), 0, 25);
  write(kFirstNew, new_records(2) + "x");
  const RawScan scan = open_dataset(folder_)->scan(0);
  EXPECT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(scan.warning, (folder_ / kFirstNew).string() +
                              ": 1 bytes after record 2 are left out: the size 59 is not a multiple of 29 bytes");
  // The size of three old records, but no content of such.
  write(kFirstNew, std::string(75, '\x41'));
  expect_within(open_dataset(folder_)->scan(0).warning, "17 bytes after record 2");
}

TEST_F(Helipr, ItsDopplerIsCompensatedWhichIsSaid) {
  write(kLastOld, old_records(1));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_EQ(dataset->scan(0).doppler_kind, DopplerKind::kCompensated);
  ASSERT_EQ(dataset->assumptions().size(), 1U);
  expect_within(dataset->assumptions()[0], "compensated");
  expect_within(dataset->assumptions()[0], "diagnosis");
}

TEST_F(Helipr, TruthIsOfTheSensorElseOfItsGlobalFile) {
  write(kLastOld, old_records(1));
  EXPECT_TRUE(open_dataset(folder_)->ground_truth().empty());
  write("LiDAR_GT/Avia_gt.txt", "1691936557946849179 9 9 9 0 0 0 1\n");
  EXPECT_TRUE(open_dataset(folder_)->ground_truth().empty());
  write("LiDAR_GT/global_Aeva_gt.txt", "1691936557946849179 400000 4000000 20 0 0 0 1\n");
  EXPECT_EQ(open_dataset(folder_)->ground_truth_file(), folder_ / "LiDAR_GT/global_Aeva_gt.txt");
  EXPECT_EQ(open_dataset(folder_)->ground_truth().at(0).T_world_sensor.translation(), Eigen::Vector3d(0, 0, 0));
  write("LiDAR_GT/Aeva_gt.txt", "1691936557946849179 1 2 3 0 0 0 1\n");
  EXPECT_EQ(open_dataset(folder_)->ground_truth_file(), folder_ / "LiDAR_GT/Aeva_gt.txt");
  EXPECT_EQ(open_dataset(folder_)->ground_truth().at(0).T_world_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  write("LiDAR_GT/Aeva_gt.txt", "1691936557946849179 1 2 3 0 0 0\n");
  expect_within(fault(), (folder_ / "LiDAR_GT/Aeva_gt.txt").string() + ": line 1: 7 columns");
}

TEST_F(Helipr, EmptyForeignAndUnfiniteScans) {
  write(kLastOld, "");
  EXPECT_TRUE(open_dataset(folder_)->scan(0).points.empty());
  expect_within(open_dataset(folder_)->scan(0).warning, kLastOld + ": empty file");
  std::string big;
  for (int i = 1; i < 50; ++i) {
    const std::string record = aeva_record(12.3F, -1.7F * static_cast<float>(i), 0.37F, -3.1F, i).substr(0, 25);
    big += swapped(record.substr(0, 24)) + record[24];
  }
  write(kLastOld, big);
  expect_within(scan_fault(0), kLastOld + ": record 0 at byte 0");
  expect_within(scan_fault(0), "expected little-endian records of 25 bytes (aeva25)");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write(kLastOld, aeva_record(nan, nan, nan, nan, 0).substr(0, 25));
  EXPECT_EQ(open_dataset(folder_)->scan(0).points.size(), 1U);
}

TEST_F(Helipr, IsFoundBelowAndByTheScansThemselves) {
  write("DCC06/" + kLastOld, old_records(1));
  EXPECT_EQ(open_dataset(folder_)->format(), "helipr");
  EXPECT_EQ(open_dataset(folder_ / "DCC06" / "LiDAR" / "Aeva")->format(), "helipr");
  write("Town01/" + kLastOld, old_records(1));
  expect_within(fault(), "holds several recordings");
  fs::remove_all(folder_ / "Town01");
  write("DCC06/LiDAR/Aeva/b_1691936557946849179.bin", "");
  expect_within(fault(), "carries the same time stamp as 1691936557946849179.bin");
}

}  // namespace
}  // namespace dynamic_icp::datasets
