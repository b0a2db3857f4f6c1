// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class Dicp : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "point_clouds");
    for (int i = 1; i <= 3; ++i) {
      write("point_clouds/0000" + std::to_string(i) + ".bin", record(static_cast<float>(i), 2, 3, -4));
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string record(float x, float y, float z, float doppler) {
    std::string bytes;
    for (const float value : {x, y, z, doppler}) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int k = 0; k < 4; ++k) {
        bytes.push_back(static_cast<char>(bits >> (8 * k) & 0xff));
      }
    }
    return bytes;
  }
  void write(const std::string& name, const std::string& content) {
    formats::write_whole_file(folder_ / name, content);
  }
  std::string message() {
    try {
      open_dataset(folder_);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  }

  const std::string kThreePoses =
      "0.0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.25 2 0 0 0 0 0.7071067811865476 0.7071067811865476\n";
  fs::path folder_ = fs::temp_directory_path() / ("dicp_test-" + std::to_string(::getpid()));
};

TEST_F(Dicp, ReadsTimesOfPointsWhereThereAreSome) {
  EXPECT_TRUE(open_dataset(folder_)->scan(1).times.empty());
  fs::create_directories(folder_ / "times");
  write("times/00002.bin", record(0.0625F, 0, 0, 0).substr(0, 4));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->scan(1).times, std::vector<double>{0.0625});
  EXPECT_THROW((void)dataset->scan(0), DataError) << "missing";
  write("times/00001.bin", record(1, 2, 3, 4));
  try {
    (void)dataset->scan(0);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("00001.bin: 1 points, expected 4 as there are times in"),
              std::string::npos)
        << error.what();
  }
}

// Three scans 0.1 s apart, each measured in 0.1 s.
TEST_F(Dicp, TimesInAnotherUnitAreTakenByWhatTheySpan) {
  write("ref_poses.txt", kThreePoses);
  fs::create_directories(folder_ / "times");
  for (const float per_second : {1.0F, 1e3F, 1e6F, 1e9F}) {
    std::string points;
    std::string times;
    for (int i = 0; i <= 100; ++i) {
      points += record(1, 2, 3, 4);
      formats::append_value(times, per_second * 0.001F * static_cast<float>(i));
    }
    formats::append_value(times, 1e3F * per_second);  // an odd one
    points += record(1, 2, 3, 4);
    for (const char* name : {"00001.bin", "00002.bin", "00003.bin"}) {
      write(std::string("point_clouds/") + name, points);
      write(std::string("times/") + name, times);
    }
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    EXPECT_NEAR(dataset->scan(1).times.at(50), 0.05, 1e-6) << per_second;
    const std::vector<std::string>& said = dataset->assumptions();
    EXPECT_EQ(std::any_of(said.begin(), said.end(), [](const auto& s) { return s.starts_with("times of points"); }),
              per_second != 1.0F);
  }
}

TEST_F(Dicp, TimesOfTwiceTheSizeAreNamed) {
  fs::create_directories(folder_ / "times");
  write("times/00001.bin", std::string(sizeof(double), '\0'));
  try {
    (void)open_dataset(folder_)->scan(0);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("float64?"), std::string::npos) << error.what();
  }
}

TEST_F(Dicp, EmptyScansHaveEmptyTimes) {
  fs::create_directories(folder_ / "times");
  write("point_clouds/00001.bin", "");
  write("times/00001.bin", "");
  const RawScan scan = open_dataset(folder_)->scan(0);
  EXPECT_TRUE(scan.points.empty() && scan.times.empty());
  EXPECT_NE(scan.warning.find("00001.bin: empty file"), std::string::npos);
}

TEST_F(Dicp, ReadsScansInOrderWithTheStampsOfThePoses) {
  write("ref_poses.txt", kThreePoses);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->format(), "dicp");
  ASSERT_EQ(dataset->size(), 3u);
  EXPECT_EQ(dataset->stamp(2).ns, 250'000'000);
  const RawScan scan = dataset->scan(1);
  EXPECT_EQ(scan.stamp.ns, 100'000'000);
  EXPECT_EQ(scan.points.at(0), Eigen::Vector3d(2, 2, 3));
  EXPECT_EQ(scan.doppler.at(0), -4.0);
  EXPECT_EQ(dataset->ground_truth().size(), 3u);
  EXPECT_EQ(dataset->ground_truth_file(), folder_ / "ref_poses.txt");
  EXPECT_TRUE(dataset->assumptions().empty());
}

TEST_F(Dicp, AssumesAPeriodWithoutPosesAndSaysSo) {
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_, {.format = "dicp"});
  EXPECT_EQ(dataset->stamp(2).ns, 200'000'000);
  EXPECT_TRUE(dataset->ground_truth().empty());
  EXPECT_TRUE(dataset->ground_truth_file().empty());
  EXPECT_EQ(dataset->assumptions().size(), 1u);
}

TEST_F(Dicp, NamesMayBeTimeStampsWithoutPoses) {
  fs::remove_all(folder_ / "point_clouds");
  fs::create_directories(folder_ / "point_clouds");
  write("point_clouds/1724479779484729506.bin", record(2, 2, 3, -4));
  write("point_clouds/1724479779384729506.bin", record(1, 2, 3, -4));
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_EQ(dataset->stamp(0).ns, 1'724'479'779'384'729'506);
  EXPECT_EQ(dataset->scan(1).points.at(0).x(), 2.0);
  EXPECT_TRUE(dataset->assumptions().empty());
}

TEST_F(Dicp, ForeignNumbersAreRefusedWithFileAndPlace) {
  std::string bytes;
  for (int i = 1; i < 50; ++i) {
    bytes += record(12.3F, -1.7F * static_cast<float>(i), 0.37F, -3.1F);
  }
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::swap(bytes[at], bytes[at + 3]);
    std::swap(bytes[at + 1], bytes[at + 2]);
  }
  write("point_clouds/00002.bin", bytes);
  try {
    (void)open_dataset(folder_)->scan(1);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("00002.bin: record 0 at byte 0 has x, y, z = "), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("records of 16 bytes (xyzd)"), std::string::npos) << error.what();
  }
}

TEST_F(Dicp, ReadsAnyFolderOfScansWhenNamed) {
  fs::create_directories(folder_ / "above");
  fs::rename(folder_ / "point_clouds", folder_ / "above" / "velodyne");
  EXPECT_THROW(open_dataset(folder_), DataError) << "KITTI";
  EXPECT_EQ(open_dataset(folder_, {.format = "dicp"})->size(), 3u);
  EXPECT_EQ(open_dataset(folder_ / "above" / "velodyne", {.format = "dicp"})->size(), 3u);
}

TEST_F(Dicp, CalibrationTurnsVehiclePosesIntoSensorPoses) {
  write("ref_poses.txt", kThreePoses);
  write("calibration.json",
        R"({"T_V_to_S": {"translation": {"x": 1.5, "y": 0, "z": 2}, "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}}})");
  const formats::Trajectory truth = open_dataset(folder_)->ground_truth();
  EXPECT_TRUE(truth[1].T_world_sensor.translation().isApprox(Eigen::Vector3d(2.5, 0, 2)));
  // The vehicle has turned left by 90 degrees: its sensor is 1.5 m to the left of the world's x axis.
  EXPECT_TRUE(truth[2].T_world_sensor.translation().isApprox(Eigen::Vector3d(2, 1.5, 2)));
}

TEST_F(Dicp, IsFoundFromAFolderAboveAndFromTheScansThemselves) {
  EXPECT_EQ(open_dataset(folder_ / "point_clouds")->size(), 3u);
  const fs::path above = folder_.string() + "-above";
  fs::create_directories(above / "unpacked");
  fs::rename(folder_, above / "unpacked" / "sequence");
  EXPECT_EQ(open_dataset(above)->size(), 3u);
  fs::remove_all(above);
}

TEST_F(Dicp, SeveralRecordingsMustBeNamed) {
  fs::create_directories(folder_ / "above" / "a" / "point_clouds");
  fs::create_directories(folder_ / "above" / "b" / "point_clouds");
  write("above/a/point_clouds/1.bin", record(1, 2, 3, 4));
  write("above/b/point_clouds/1.bin", record(1, 2, 3, 4));
  EXPECT_THROW(open_dataset(folder_ / "above"), NotARecording);
}

TEST_F(Dicp, WrongPosesAreErrorsThatNameThem) {
  write("ref_poses.txt", "0.0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n");
  EXPECT_NE(message().find("2 poses for 3 scans"), std::string::npos) << message();
  write("ref_poses.txt", "0.0 0 0 0 0 0 0 1\n0.1 1 0 0\n0.2 0 0 0 0 0 0 1\n");
  EXPECT_NE(message().find("ref_poses.txt"), std::string::npos);
  EXPECT_NE(message().find("2"), std::string::npos) << "the line";
  write("ref_poses.txt", "0.2 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.3 0 0 0 0 0 0 1\n");
  EXPECT_NE(message(), "no error") << "time runs backwards";
  try {
    open_dataset(folder_);
  } catch (const NotARecording& error) {
    FAIL() << "is one, though damaged: " << error.what();
  } catch (const DataError&) {
  }
}

TEST_F(Dicp, NothingFollowsACalibration) {
  write("ref_poses.txt", kThreePoses);
  std::string text = R"({"T_V_to_S": {"translation": {"x": 0, "y": 0, "z": 0},
                         "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}}})";
  write("calibration.json", text);
  EXPECT_EQ(message(), "no error");
  text.append(100, '\0');
  write("calibration.json", text);
  EXPECT_NE(message().find("calibration.json: line 2: has a zero byte"), std::string::npos) << message();
}

TEST_F(Dicp, WrongCalibrationsAreErrors) {
  write("ref_poses.txt", kThreePoses);
  for (const char* text :
       {"{", "{}", R"({"T_V_to_S": {"translation": {"x": "a"}}})",
        R"({"T_V_to_S": {"translation": {"x": 0, "y": 0, "z": 0}, "quaternion": {"w": 2, "x": 0, "y": 0, "z": 0}}})"}) {
    write("calibration.json", text);
    EXPECT_NE(message().find("calibration.json"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
