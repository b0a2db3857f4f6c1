// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/calibration.hpp"

#include <numbers>

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

const std::string kLeft = R"({"translation": {"x": 1, "y": 2, "z": 3},
                              "quaternion": {"w": 0.7071067811865476, "x": 0, "y": 0, "z": 0.7071067811865476}})";

/// A scan of two points, x y z Doppler and what `columns` says of them.
std::string pcd(const std::string& columns, const std::string& first, const std::string& second) {
  std::string size;
  std::string type;
  for (const char c : columns) {
    size += c == ' ' ? " 4" : "";
    type += c == ' ' ? " F" : "";
  }
  return "FIELDS x y z doppler" + columns + "\nSIZE 4 4 4 4" + size + "\nTYPE F F F F" + type +
         "\nPOINTS 2\nDATA ascii\n1 0 0 -4 " + first + "\n1 2 4 -5 " + second + "\n";
}

class CalibrationFile : public RecordingByHand {
 protected:
  [[nodiscard]] std::string fault_in(const std::string& text) const {
    const std::filesystem::path path = write("calibration.json", text);
    return fault_of([&] { (void)read_calibration(path); });
  }
};

TEST_F(CalibrationFile, SaysWhereSensorsSit) {
  const Calibration one = read_calibration(write("a.json", R"({"T_V_to_S": )" + kLeft + "}"));
  EXPECT_TRUE(one.mountings.empty());
  // The axis of the sensor points to the left of the vehicle.
  EXPECT_TRUE((*one.T_vehicle_sensor * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3)));
  const Calibration rig =
      read_calibration(write("b.json", R"({"sensors": [{"T_scan_sensor": )" + kLeft + R"(, "name": "left"}]})"));
  EXPECT_FALSE(rig.T_vehicle_sensor);
  ASSERT_EQ(rig.mountings.size(), 1U);
  EXPECT_TRUE(rig.mountings[0].isApprox(*one.T_vehicle_sensor));
}

TEST_F(CalibrationFile, IsReadAsItWasWritten) {
  Calibration calibration;
  calibration.T_vehicle_sensor =
      Eigen::Translation3d(1.5, -0.25, 2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  calibration.mountings = {Eigen::Isometry3d::Identity(), calibration.T_vehicle_sensor->inverse()};
  const Calibration read = read_calibration(write("a.json", calibration_text(calibration)));
  EXPECT_TRUE(read.T_vehicle_sensor->isApprox(*calibration.T_vehicle_sensor, 1e-15));
  ASSERT_EQ(read.mountings.size(), 2U);
  EXPECT_TRUE(read.mountings[1].isApprox(calibration.mountings[1], 1e-15));
}

TEST_F(CalibrationFile, WrongOnesAreErrors) {
  for (const std::string text :
       {"[]", "{}", R"({"sensors": 3})", R"({"sensors": [{}]})",
        R"({"sensors": [{"T_scan_sensor": {"translation": 1}}]})", R"({"T_V_to_S": 1, "sensors": []})"}) {
    expect_within(fault_in(text), (folder_ / "calibration.json").string() + ": expected {\"T_V_to_S\": ");
  }
  expect_within(fault_in(R"({"sensors": []})"), "calibration.json: 0 sensors, expected 1 to 256");
  expect_within(fault_in(R"({"sensors": [{"T_scan_sensor": {"translation": {"x": 0, "y": 0, "z": 0},
                            "quaternion": {"w": 2, "x": 0, "y": 0, "z": 0}}}]})"),
                "quaternion has length 2");
}

TEST_F(CalibrationFile, BesideColumnsMakesThemARig) {
  write("1.pcd", pcd(" lidar", "0", "1"));
  EXPECT_TRUE(open_dataset(folder_)->scan(0).mountings.empty());
  const std::string second = kLeft;
  const std::string first =
      R"({"translation": {"x": 0, "y": 0, "z": 0}, "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}})";
  const std::string sensors =
      R"({"sensors": [{"T_scan_sensor": )" + first + R"(}, {"T_scan_sensor": )" + second + "}]}";
  write("calibration.json", sensors);
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  const RawScan scan = dataset->scan(0);
  EXPECT_FALSE(dataset->T_vehicle_sensor());
  EXPECT_EQ(scan.channels.sensor, (std::vector<std::uint8_t>{0, 1}));
  ASSERT_EQ(scan.mountings.size(), 2U);
  // The second point lies above its sensor, whatever its place in the frame of the scan.
  EXPECT_TRUE(Scan::from_raw(scan).directions()[1].isApprox(Eigen::Vector3d::UnitZ()));

  write("1.pcd", pcd(" lidar", "0", "2"));
  expect_within(scan_fault(0), "1.pcd: point 1 is of sensor 2, but calibration.json has 2 sensors");
  write("1.pcd", pcd("", "", ""));
  const std::unique_ptr<Dataset> without = open_dataset(folder_);
  EXPECT_TRUE(without->scan(0).mountings.empty());
  EXPECT_TRUE(said(*without, "no column says which of them measured a point"));
  write("calibration.json", R"({"camera": "some other calibration"})");
  EXPECT_TRUE(said(*open_dataset(folder_), "calibration.json: is not used"));
  write("calibration.json", sensors.substr(0, 60));
  expect_within(fault(), "calibration.json: expected {");
}

TEST_F(CalibrationFile, OfARigHelpsNoDicp) {
  write("point_clouds/1.bin", floats({1, 2, 3, 4}));
  write("calibration.json", R"({"sensors": [{"T_scan_sensor": )" + kLeft + "}]}");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  EXPECT_TRUE(dataset->scan(0).mountings.empty());
  EXPECT_TRUE(said(*dataset, "the mountings of its 1 sensors are not used"));
}

}  // namespace
}  // namespace dynamic_icp::datasets
