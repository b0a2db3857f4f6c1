// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "dynamic_icp/recording/datasets/layouts.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

// x y z velocity intensity signal_quality reflectivity time lsb msb
std::string record40(float x, float time_ns) {
  return floats({x, 2, 3, -4.25F, 11, 12, 13, time_ns, static_cast<float>(37 << 8), 1});
}

const std::string kHeader = "GPSTime,easting,northing,altitude,vel_east,vel_north,vel_up,roll,pitch,heading,wz,wy,wx\n";

class Boreas : public RecordingByHand {
 protected:
  void write_poses(const std::string& rows) const { write("applanix/aeva_poses.csv", kHeader + rows); }
};

class BoreasRt : public Boreas {
 protected:
  void SetUp() override {
    Boreas::SetUp();
    write("aeva/1724479779384729.bin", record40(1, 0) + record40(2, 50'000'000));
    write("aeva/1724479779484729.bin", record40(5, 1000));
    write_poses(
        "1724479779384729,600000.5,4800000.25,100,0,0,0,0,0,0,0,0,0\n"
        "1724479779484729,600002.5,4800000.25,101,0,0,0,0,0,0,0,0,0\n");
  }
};

TEST_F(BoreasRt, ScansTruthAndColumns) {
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "boreas");
  ASSERT_EQ(dataset->size(), 2U);
  EXPECT_EQ(dataset->stamp(0).ns, 1'724'479'779'384'729'000);
  const RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.stamp, dataset->stamp(0));
  EXPECT_EQ(scan.points.at(1), Eigen::Vector3d(2, 2, 3));
  EXPECT_EQ(scan.doppler.at(1), -4.25);
  EXPECT_DOUBLE_EQ(scan.times.at(1), 0.05);
  EXPECT_EQ(column(*dataset, 0, "intensity"), (std::vector<double>{11, 11}));
  EXPECT_EQ(column(*dataset, 0, "line_index"), (std::vector<double>{37, 37}));
  EXPECT_EQ(dataset->ground_truth_file(), folder_ / "applanix" / "aeva_poses.csv");
  ASSERT_EQ(dataset->ground_truth().size(), 2U);
  EXPECT_EQ(dataset->ground_truth()[1].stamp, dataset->stamp(1));
  EXPECT_EQ(dataset->ground_truth()[1].T_world_sensor.translation(), Eigen::Vector3d(2, 0, 1));
  EXPECT_TRUE(dataset->assumptions().empty());
}

// With the published elementary matrices, written out.
TEST_F(BoreasRt, AnglesOfThePosesTurnTheAxes) {
  const double roll = 0.1;
  const double pitch = -0.2;
  const double yaw = 2.5;
  Eigen::Matrix3d Rx;
  Rx << 1, 0, 0, 0, std::cos(roll), std::sin(roll), 0, -std::sin(roll), std::cos(roll);
  Eigen::Matrix3d Ry;
  Ry << std::cos(pitch), 0, -std::sin(pitch), 0, 1, 0, std::sin(pitch), 0, std::cos(pitch);
  Eigen::Matrix3d Rz;
  Rz << std::cos(yaw), std::sin(yaw), 0, -std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
  write_poses("1724479779384729,1,2,3,0,0,0,0.1,-0.2,2.5,0,0,0\n");
  const Eigen::Isometry3d T = open_dataset(folder_)->ground_truth().at(0).T_world_sensor;
  EXPECT_TRUE(T.linear().isApprox(Rx * Ry * Rz, 1e-12)) << T.linear();
  EXPECT_EQ(T.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(BoreasRt, CalibrationGivesThePoseOfTheSensor) {
  EXPECT_FALSE(open_dataset(folder_)->T_vehicle_sensor());
  write("calib/T_applanix_lidar.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  EXPECT_FALSE(open_dataset(folder_)->T_vehicle_sensor());
  write("calib/T_aeva_lidar.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const auto T = open_dataset(folder_)->T_vehicle_sensor();
  ASSERT_TRUE(T);
  // The origin of the Aeva lies at x = -0.5 of the other LiDAR, which is y = -0.5 of the vehicle further on.
  EXPECT_TRUE(T->translation().isApprox(Eigen::Vector3d(1, 1.5, 3)));
  write("calib/T_aeva_lidar.txt", "1 0 0 0.5\n0 1 0 0\n");
  expect_within(fault(), "T_aeva_lidar.txt: 8 numbers, expected the 12 of a 3x4 or the 16 of a 4x4");
}

TEST_F(BoreasRt, WrongPosesNameFileAndLine) {
  const std::string name = (folder_ / "applanix" / "aeva_poses.csv").string();
  write_poses("1724479779384729,1,2,3\n");
  expect_within(fault(), name + ": line 2: 4 columns, expected at least 10");
  write_poses("17244797793,1,2,3,0,0,0,0,0,0,0,0,0\n");
  expect_within(fault(), name + ": line 2: the time stamp is '17244797793', expected Unix time");
  write_poses("1724479779384729,1,2,3,0,0,0,0,nan,0,0,0,0\n");
  expect_within(fault(), name + ": line 2: a number is not finite");
  write_poses("1724479779384729,1,2,x,0,0,0,0,0,0,0,0,0\n");
  expect_within(fault(), name + ": line 2: 'x' is no number");
  const std::string row = "1724479779384729,1,2,3,0,0,0,0,0,0,0,0,0\n";
  write_poses(row + row);
  expect_within(fault(), name + ": line 3: the time stamp 1724479779.384729000 comes after 1724479779.384729000");
  write_poses("");
  expect_within(fault(), name + ": no pose in this file");
}

TEST_F(BoreasRt, WithoutTruthItNeedsCalibOrItsName) {
  fs::remove_all(folder_ / "applanix");
  expect_within(fault(), "not a recording of a known layout");
  EXPECT_EQ(open_dataset(folder_, {.format = "boreas"})->size(), 2U);
  write("calib/camera.txt", "");
  EXPECT_TRUE(open_dataset(folder_)->ground_truth().empty());
  EXPECT_EQ(open_dataset(folder_ / "aeva")->size(), 2U);
  EXPECT_EQ(open_dataset(above_)->size(), 2U);
}

TEST_F(BoreasRt, CutEmptyUnfiniteAndForeignScans) {
  const fs::path file = write("aeva/1724479779584729.bin", record40(1, 2) + std::string(39, 'x'));
  expect_within(open_dataset(folder_)->scan(2).warning, file.string() + ": 39 bytes after record 1");
  write("aeva/1724479779584729.bin", "");
  expect_within(open_dataset(folder_)->scan(2).warning, file.string() + ": empty file");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write("aeva/1724479779584729.bin", floats({nan, nan, nan, nan, nan, nan, nan, nan, nan, nan}));
  EXPECT_EQ(open_dataset(folder_)->scan(2).points.size(), 1U);
  EXPECT_EQ(column(*open_dataset(folder_), 2, "line_index"), std::vector<double>{0});
  std::string big;
  for (int i = 1; i < 50; ++i) {
    big += swapped(floats({12.3F, -1.7F * static_cast<float>(i), 0.37F, -3.1F, 1, 2, 3, 4, 5, 6}));
  }
  write("aeva/1724479779584729.bin", big);
  expect_within(scan_fault(2), file.string() + ": record 0 at byte 0");
  expect_within(scan_fault(2), "records of 40 bytes (boreas40)");
  write("aeva/a_1724479779484729.bin", "");
  expect_within(fault(), "a_1724479779484729.bin: carries the same time stamp as 1724479779484729.bin");
}

std::string many(const std::string& front, const std::function<std::string(int)>& back) {
  std::string bytes;
  for (int i = 0; i < 60; ++i) {
    bytes += front + back(i);
  }
  return bytes;
}

float time_of(int i) { return 0.0015F * static_cast<float>(i); }

TEST_F(Boreas, OlderRecordsAreToldByTheirContent) {
  write("calib/camera.txt", "");
  const std::string front = floats({1, 2, 3, 11, -4.25F});
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"24", many(front, [](int i) { return floats({time_of(i)}); })},
      {"28", many(front,
                  [](int i) {
                    return floats({time_of(i), static_cast<float>(i % 4)});
                  })},
      {"28", many(front,
                  [](int i) {
                    return floats({static_cast<float>(i % 4), time_of(i)});
                  })},
      {"32", many(front, [](int i) {
         return floats({time_of(i), static_cast<float>(i % 4), 0.0F});
       })}};
  for (const auto& [size, bytes] : kinds) {
    write("aeva/1660000000000000.bin", "");
    write("aeva/1660000000100000.bin", bytes);
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    const RawScan scan = dataset->scan(1);
    ASSERT_EQ(scan.points.size(), 60U);
    EXPECT_EQ(scan.points[59], Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(scan.doppler[59], -4.25);
    EXPECT_EQ(scan.times[59], static_cast<double>(time_of(59))) << size;
    EXPECT_EQ(column(*dataset, 1, "intensity").at(59), 11);
    if (size != "24") {
      EXPECT_EQ(column(*dataset, 1, "beam_id").at(59), 3);
    }
    ASSERT_EQ(dataset->assumptions().size(), 1U);
    expect_within(dataset->assumptions()[0], "records of " + size + " bytes");
  }
}

class AevaSet : public RecordingByHand {
 protected:
  void SetUp() override {
    RecordingByHand::SetUp();
    for (int i = 8; i <= 10; ++i) {
      write("frames/" + std::to_string(i) + ".bin", floats({static_cast<float>(i), 2, 3, -4.25F, 0.0625F}));
    }
    write("timestamps.txt", "1660000000.125\n1660000000.225\n1660000000.325\n");
    write("aeva_poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1.5 0 1 0 0 0 0 1 0\n0 -1 0 3 1 0 0 0.5 0 0 1 0\n");
  }
};

TEST_F(AevaSet, ScansTimesAndPoses) {
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "boreas");
  ASSERT_EQ(dataset->size(), 3U);
  EXPECT_EQ(dataset->stamp(1).ns, 1'660'000'000'225'000'000);
  const RawScan scan = dataset->scan(2);
  EXPECT_EQ(scan.points.at(0), Eigen::Vector3d(10, 2, 3)) << "by number, not as text";
  EXPECT_EQ(scan.doppler.at(0), -4.25);
  EXPECT_EQ(scan.times.at(0), 0.0625);
  EXPECT_EQ(dataset->ground_truth_file(), folder_ / "aeva_poses.txt");
  EXPECT_EQ(dataset->ground_truth().at(2).stamp, dataset->stamp(2));
  EXPECT_TRUE(
      (dataset->ground_truth()[2].T_world_sensor * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(3, 1.5, 0)));
  EXPECT_EQ(open_dataset(folder_ / "frames")->size(), 3U);
}

TEST_F(AevaSet, WrongTimesAndPosesNameFileAndLine) {
  write("timestamps.txt", "1660000000.125\n1660000000.225\n");
  expect_within(fault(), (folder_ / "timestamps.txt").string() + ": 2 lines for 3 scans, expected one per scan");
  write("timestamps.txt", "1660000000.125\nsoon\n1660000000.325\n");
  expect_within(fault(), (folder_ / "timestamps.txt").string() + ": line 2: is 'soon', expected one time in seconds");
  write("timestamps.txt", "1660000000.125\n1660000000.325\n1660000000.225\n");
  expect_within(fault(), "timestamps.txt: line 3: the time 1660000000.225000000 comes after 1660000000.325000000");
  write("timestamps.txt", "0.1\n0.2\n0.3\n");
  write("aeva_poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expect_within(fault(), (folder_ / "aeva_poses.txt").string() + ": 1 lines for 3 scans");
  write("aeva_poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0\n");
  expect_within(fault(), "aeva_poses.txt: line 3: 10 numbers");
  fs::remove(folder_ / "aeva_poses.txt");
  EXPECT_TRUE(open_dataset(folder_, {.format = "boreas"})->ground_truth().empty());
}

}  // namespace
}  // namespace dynamic_icp::datasets
