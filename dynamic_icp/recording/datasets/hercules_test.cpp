// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class Hercules : public RecordingByHand {
 protected:
  void SetUp() override {
    RecordingByHand::SetUp();
    write("LiDAR/Aeva/1724479779484729506.bin", aeva_record(2, -3, 4, 5, 6'700'000));
    write("LiDAR/Aeva/1724479779384729506.bin", aeva_record(1, 2, 3, -4, 0) + aeva_record(1, 2, 3, -4.5F, -1000));
  }
  void write_truth(const std::string& rows) const { write("PR_GT/Aeva_gt.txt", rows); }

  const std::string kTruth =
      "1724479779384729506 1 2 3 0 0 0 1\n1724479779484729506 2 2 3 0 0 0.7071067811865476 0.7071067811865476\n";
};

TEST_F(Hercules, ScansTruthAndColumns) {
  write_truth(kTruth);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "hercules");
  ASSERT_EQ(dataset->size(), 2U);
  EXPECT_EQ(dataset->stamp(0).ns, 1'724'479'779'384'729'506);
  EXPECT_EQ(dataset->scan_file(1), folder_ / "LiDAR" / "Aeva" / "1724479779484729506.bin");
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kRelative);
  const RawScan scan = dataset->scan(1);
  EXPECT_EQ(scan.stamp.ns, 1'724'479'779'484'729'506);
  EXPECT_EQ(scan.points.at(0), Eigen::Vector3d(2, -3, 4));
  EXPECT_EQ(scan.doppler.at(0), 5.0);
  EXPECT_DOUBLE_EQ(scan.times.at(0), 0.0067);
  EXPECT_EQ(scan.warning, "");
  EXPECT_EQ(column(*dataset, 0, "reflectivity"), (std::vector<double>{20.5, 20.5}));
  EXPECT_EQ(column(*dataset, 0, "line_index"), (std::vector<double>{7, 7}));
  EXPECT_EQ(column(*dataset, 0, "intensity"), (std::vector<double>{-57, -57}));
  EXPECT_EQ(dataset->ground_truth_file(), folder_ / "PR_GT" / "Aeva_gt.txt");
  ASSERT_EQ(dataset->ground_truth().size(), 2U);
  EXPECT_EQ(dataset->ground_truth()[1].stamp, dataset->stamp(1));
  EXPECT_EQ(dataset->ground_truth()[1].T_world_sensor.translation(), Eigen::Vector3d(2, 2, 3));
  EXPECT_TRUE(dataset->assumptions().empty());
  EXPECT_FALSE(dataset->T_vehicle_sensor());
}

TEST_F(Hercules, IsKnownByItsRadarOrItsYearWithoutTruth) {
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "hercules") << "2024";
  EXPECT_TRUE(dataset->ground_truth().empty());
  EXPECT_TRUE(dataset->ground_truth_file().empty());
  fs::remove_all(folder_ / "LiDAR");
  write("LiDAR/Aeva/1691936557946849179.bin", aeva_record(1, 2, 3, 4, 5));
  EXPECT_EQ(open_dataset(folder_)->format(), "helipr") << "2023, and nothing else";
  write("Radar/Continental/1691936557946849179.bin", "");
  EXPECT_EQ(open_dataset(folder_)->format(), "hercules");
  fs::remove_all(folder_ / "Radar");
  EXPECT_EQ(open_dataset(folder_, {.format = "hercules"})->format(), "hercules") << "named";
}

TEST_F(Hercules, PartsMayBeSpelledOtherwiseAndLieInFoldersOfTheirOwn) {
  fs::create_directories(folder_ / "Aeva_data");
  fs::rename(folder_ / "LiDAR", folder_ / "Aeva_data" / "lidar");
  fs::rename(folder_ / "Aeva_data" / "lidar" / "Aeva", folder_ / "Aeva_data" / "lidar" / "aeva");
  write("GT/pr_gt/aeva_gt.txt", kTruth);
  for (const fs::path& input : {folder_, folder_ / "Aeva_data", folder_ / "Aeva_data" / "lidar",
                                folder_ / "Aeva_data" / "lidar" / "aeva", folder_ / "Aeva_data" / ""}) {
    const std::unique_ptr<Dataset> dataset = open_dataset(input);
    EXPECT_EQ(dataset->format(), "hercules");
    EXPECT_EQ(dataset->size(), 2U);
    EXPECT_EQ(dataset->ground_truth_file(), folder_ / "GT" / "pr_gt" / "aeva_gt.txt") << input;
  }
}

TEST_F(Hercules, PartsMayLieInTheFolderAbove) {
  fs::create_directories(folder_ / "Aeva_data");
  fs::rename(folder_ / "LiDAR", folder_ / "Aeva_data" / "LiDAR");
  write_truth(kTruth);
  EXPECT_EQ(open_dataset(folder_)->ground_truth_file(), folder_ / "PR_GT" / "Aeva_gt.txt");
}

TEST_F(Hercules, TheTruthOfTheRecordingBesideIsNotTaken) {
  fs::rename(folder_ / "LiDAR", folder_ / "...");
  write("02_Night/LiDAR/Aeva/1724479779384729506.bin", aeva_record(1, 2, 3, 4, 5));
  write("02_Night/PR_GT/Aeva_gt.txt", kTruth);
  fs::create_directories(folder_ / "01_Day");
  fs::rename(folder_ / "...", folder_ / "01_Day" / "LiDAR");
  EXPECT_TRUE(open_dataset(folder_ / "01_Day")->ground_truth().empty());
  EXPECT_EQ(open_dataset(folder_ / "02_Night")->ground_truth().size(), 2U);
  expect_within(fault(), "holds several recordings, name one of them:\n  " + (folder_ / "01_Day").string() + "\n  " +
                             (folder_ / "02_Night").string());
}

TEST_F(Hercules, CalibrationGivesThePoseOfTheSensorInTheImu) {
  write("Calibration/IMU_LiDAR.txt", "calibrated\nTr_lidar_to_imu: 0 -1 0 1.219 1 0 0 -0.011 0 0 1 0.014\n");
  const auto T = open_dataset(folder_)->T_vehicle_sensor();
  ASSERT_TRUE(T);
  EXPECT_TRUE((*T * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1.219, 0.989, 0.014)));
  write("Calibration/IMU_LiDAR.txt", "Tr_lidar_to_imu: 0 -1 0 1.219\n");
  expect_within(fault(), "IMU_LiDAR.txt: line 1: 4 numbers, expected the 12");
  write("Calibration/IMU_LiDAR.txt", "\nTr_lidar_to_imu: 2 0 0 0 0 1 0 0 0 0 1 0\n");
  expect_within(fault(), "IMU_LiDAR.txt: line 2: the first three columns are no rotation");
  write("Calibration/IMU_LiDAR.txt", "Tr_lidar_to_imu: 1 0 0 zero\n");
  expect_within(fault(), "IMU_LiDAR.txt: line 1: 'zero' is no number");
  write("Calibration/IMU_LiDAR.txt", "Tr: 1 0 0\n");
  expect_within(fault(), "IMU_LiDAR.txt: no line 'Tr_lidar_to_imu:'");
}

TEST_F(Hercules, LargeCoordinatesOfTheTruthBeginAtTheOrigin) {
  write_truth(
      "1724479779384729506 345678.125 4012345.25 33 0 0 0 1\n1724479779484729506 345679.625 4012345.25 34 0 0 0 1\n"
      "1724479779584729506 345681.125 4012345.25 35 0 0 0 1\n");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  ASSERT_EQ(dataset->ground_truth().size(), 3U) << "more rows than scans";
  EXPECT_EQ(dataset->ground_truth()[0].T_world_sensor.translation(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(dataset->ground_truth()[1].T_world_sensor.translation(), Eigen::Vector3d(1.5, 0, 1));
}

TEST_F(Hercules, TruthMayBeInSecondsAndOfFewerScans) {
  write_truth("1724479779.434729506 1 2 3 0 0 0 1\n");
  EXPECT_EQ(open_dataset(folder_)->ground_truth().at(0).stamp.ns, 1'724'479'779'434'729'506);
}

TEST_F(Hercules, TruthOfAnotherTimeIsNotUsedAndItIsSaid) {
  write_truth("1724479999384729506 1 2 3 0 0 0 1\n");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_TRUE(dataset->ground_truth().empty() && dataset->ground_truth_file().empty());
  ASSERT_EQ(dataset->assumptions().size(), 1U);
  expect_within(dataset->assumptions()[0],
                (folder_ / "PR_GT" / "Aeva_gt.txt").string() + ": its poses from 1724479999.384729506 to ");
}

TEST_F(Hercules, WrongTruthNamesFileAndLine) {
  const std::string name = (folder_ / "PR_GT" / "Aeva_gt.txt").string();
  write_truth(kTruth + "1724479779584729506 2 2 3\n");
  expect_within(fault(), name + ": line 3: 4 columns");
  write_truth(kTruth + "1724479779384729506 2 2 3 0 0 0 1\n");
  expect_within(fault(), name + ": line 3: the time stamp 1724479779.384729506 comes after 1724479779.484729506");
  write_truth(kTruth + "1724479779484729506 9 9 9 0 0 0 1\n");
  expect_within(fault(), name + ": line 3: the time stamp 1724479779.484729506 occurs a second time");
  write_truth("1724479779384729506 nan 2 3 0 0 0 1\n");
  expect_within(fault(), name + ": line 1: tx is 'nan'");
  write_truth("");
  expect_within(fault(), name + ": line 1: no pose");
  write_truth("version https://git-lfs.github.com/spec/v1\n");
  expect_within(fault(), "Git LFS pointer");
}

TEST_F(Hercules, RepeatedLinesOfTheTruthAreSaid) {
  write_truth("1724479779384729506 1 2 3 0 0 0 1\n1724479779384729506 1 2 3 0 0 0 1\n");
  expect_within(open_dataset(folder_)->assumptions().at(0), "Aeva_gt.txt: 1 lines repeat");
}

TEST_F(Hercules, CutAndEmptyScansAreWarnings) {
  const fs::path cut = write("LiDAR/Aeva/1724479779584729506.bin", aeva_record(1, 2, 3, 4, 5) + std::string(28, 'x'));
  const RawScan scan = open_dataset(folder_)->scan(2);
  EXPECT_EQ(scan.points.size(), 1U);
  EXPECT_EQ(scan.warning,
            cut.string() + ": 28 bytes after record 1 are left out: the size 57 is not a multiple of 29 bytes");
  const fs::path empty = write("LiDAR/Aeva/1724479779684729506.bin", "");
  EXPECT_TRUE(open_dataset(folder_)->scan(3).points.empty());
  EXPECT_EQ(open_dataset(folder_)->scan(3).warning, empty.string() + ": empty file, taken as a scan without points");
  EXPECT_TRUE(open_dataset(folder_)->columns(3).at(0).values.empty());
}

TEST_F(Hercules, NumbersThatAreNotFiniteAreHandedOn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string filled;
  for (int i = 0; i < 300; ++i) {
    filled += aeva_record(nan, nan, nan, nan, i);
  }
  write("LiDAR/Aeva/1724479779584729506.bin", filled);
  const RawScan scan = open_dataset(folder_)->scan(2);
  EXPECT_EQ(scan.points.size(), 300U);
  EXPECT_TRUE(std::isnan(scan.doppler.at(299)));
  Scan::Dropped dropped;
  EXPECT_TRUE(Scan::from_raw(scan, &dropped).empty());
  EXPECT_EQ(dropped.non_finite, 300U);
}

TEST_F(Hercules, ForeignNumbersAreRefusedWithFileAndPlace) {
  std::string little;
  for (int i = 1; i < 100; ++i) {
    const auto k = static_cast<float>(i);
    little += aeva_record(12.3F + k, -1.7F * k, 0.37F, -3.1F, 1000 * i);
  }
  std::string big;
  for (std::size_t at = 0; at < little.size(); at += 29) {
    const std::string record = little.substr(at, 29);
    big += swapped(record.substr(0, 24)) + record[24] + swapped(record.substr(25));
  }
  const fs::path file = write("LiDAR/Aeva/1724479779584729506.bin", big);
  expect_within(scan_fault(2), file.string() + ": record 0 at byte 0 has x, y, z = ");
  expect_within(scan_fault(2), "expected little-endian records of 29 bytes (aeva29)");
  write("LiDAR/Aeva/1724479779584729506.bin", little);
  EXPECT_EQ(scan_fault(2), "no error");
}

TEST_F(Hercules, StampsNamedTwiceOrNotAtAllAreErrors) {
  write("LiDAR/Aeva/a_1724479779384729506.bin", "");
  expect_within(fault(), "a_1724479779384729506.bin: carries the same time stamp as 1724479779384729506.bin");
  fs::remove(folder_ / "LiDAR" / "Aeva" / "a_1724479779384729506.bin");
  write("LiDAR/Aeva/00001.bin", "");
  expect_within(fault(), "is another kind of number than that of 00001.bin");
}

TEST_F(Hercules, MissingFoldersAndFiles) {
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  fs::remove(dataset->scan_file(1));
  try {
    (void)dataset->scan(1);
    FAIL();
  } catch (const DataError& error) {
    expect_within(error.what(), dataset->scan_file(1).string() + ": cannot open: No such file");
  }
  fs::remove_all(folder_ / "LiDAR");
  expect_within(fault(), folder_.string() + ": not a recording of a known layout");
  expect_within(fault({.format = "hercules"}), "LiDAR/Aeva/*.bin");
}

TEST_F(Hercules, ArchivesAreNamedWhereScansWereExpected) {
  write("LiDAR/Aeva/1724479779584729506.bin", "PK\x03\x04...");
  expect_within(scan_fault(2), "1724479779584729506.bin: is a zip archive; unpack it first");
}

}  // namespace
}  // namespace dynamic_icp::datasets
