// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUuid = "9e107d9d-3721-4b6e-8a0e-d41d8cd98f00";
constexpr const char* kTurnedLeft = R"("rotation": {"w": 0.7071067811865476, "x": 0, "y": 0, "z": 0.7071067811865476})";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

class AevaScenes : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "pointcloud_compensated");
    for (const char* stamp : {"1700000000000000000", "1700000000100000000"}) {
      write_points("pointcloud_compensated", std::string("front_wide_lidar_") + stamp, 0.5F);
      write_points("pointcloud_compensated", std::string("left_lidar_") + stamp, -2.0F);
    }
    write_sequence(old_sequence());
  }
  void TearDown() override { fs::remove_all(root_); }

  template <class Number>
  static formats::NpzMember member(const char* name, std::vector<std::size_t> shape,
                                   const std::vector<Number>& values) {
    return {name, formats::npy_array<Number>(std::move(shape), values)};
  }

  /// Two points, the second at the origin of the LiDAR.
  void write_points(const std::string& folder, const std::string& name, float velocity) const {
    fs::create_directories(folder_ / folder);
    formats::write_npz(folder_ / folder / (name + ".npz"),
                       std::vector<formats::NpzMember>{member<float>("xyz", {2, 3}, {3, 4, 0, 0, 0, 0}),
                                                       member<float>("velocity", {2, 1}, {velocity, 0}),
                                                       member<float>("reflectivity", {2, 1}, {8191, 7.5F}),
                                                       member<std::uint32_t>("line_index", {2, 1}, {63, 1}),
                                                       member<std::uint32_t>("time_offset_ns", {2}, {0, 99'000'000}),
                                                       member<std::int64_t>("semantic_labels_idx", {2, 1}, {1, 19})});
  }

  /// Release v0.x: one path for each LiDAR; the later frame first, its stamp as text.
  static std::string old_sequence() {
    const std::string text = R"({
  "metadata": {
    "sensors": {"lidars": ["left_lidar", "front_wide_lidar"], "cameras": []},
    "vehicle_to_lidar_extrinsics": {
      "front_wide_lidar": {"translation": {"x": 1.5, "y": 0, "z": 2}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}},
      "left_lidar": {"translation": {"x": 0.5, "y": 0.25, "z": 2}, TURNED}}},
  "frames": [
    {"timestamp_ns": "1700000000100000000", "frame_idx": 1,
     "ego_pose": {"translation": {"x": 10, "y": 0, "z": 0}, TURNED},
     "point_cloud": {"left_lidar": {"point_cloud_path": "pointcloud_compensated/left_lidar_1700000000100000000.npz"},
       "front_wide_lidar": {"point_cloud_path": "pointcloud_compensated/front_wide_lidar_1700000000100000000.npz"}},
     "boxes": []},
    {"timestamp_ns": 1700000000000000000, "frame_idx": 0,
     "ego_pose": {"translation": {"x": 0, "y": 0, "z": 0}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}},
     "point_cloud": {"left_lidar": {"point_cloud_path": "pointcloud_compensated/left_lidar_1700000000000000000.npz"},
       "front_wide_lidar": {"point_cloud_path": "pointcloud_compensated/front_wide_lidar_1700000000000000000.npz"}},
     "boxes": [{"id": "b1", "reference_frame": "VEHICLE", "class": "car", "dimensions": {"x": 4, "y": 2, "z": 1.5},
       "pose": {"translation": {"x": 0.5, "y": 10.25, "z": 2}, TURNED},
       "linear_velocity": {"x": 0, "y": 7, "z": 0}}]}]})";
    return replaced(text, "TURNED", kTurnedLeft);
  }
  /// Release v2: both paths.
  static std::string new_sequence() {
    std::string text = old_sequence();
    for (const std::string name : {"left_lidar_1700000000100000000", "front_wide_lidar_1700000000100000000",
                                   "left_lidar_1700000000000000000", "front_wide_lidar_1700000000000000000"}) {
      text = replaced(text, R"("point_cloud_path": "pointcloud_compensated/)" + name + ".npz",
                      R"("point_cloud_compensated_path": "pointcloud_compensated/)" + name +
                          R"(.npz", "point_cloud_raw_path": "pointcloud_raw/)" + name + ".npz");
    }
    return text;
  }
  void write_sequence(const std::string& text) const { formats::write_whole_file(folder_ / "sequence.json", text); }

  [[nodiscard]] std::string message() const { return fault_of_reading(root_); }
  void expect_message(const std::string& part) const { expect_within(message(), part); }

  fs::path root_ = fs::temp_directory_path() / ("aevascenes_test-" + std::to_string(::getpid()));
  fs::path folder_ = root_ / kUuid;
};

TEST_F(AevaScenes, OneLidarStaysInItsOwnFrame) {
  const std::unique_ptr<Dataset> dataset = open_dataset(root_, {.sensors = {"left_lidar"}});
  EXPECT_EQ(dataset->format(), "aevascenes");
  ASSERT_EQ(dataset->size(), 2u);
  EXPECT_EQ(dataset->stamp(0).ns, 1'700'000'000'000'000'000) << "ordered by stamps";
  const RawScan scan = dataset->scan(0);
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_EQ(scan.points[0], Eigen::Vector3d(3, 4, 0));
  EXPECT_TRUE(scan.directions.empty());
  EXPECT_EQ(scan.doppler, (std::vector<double>{-2, 0}));
  EXPECT_EQ(scan.times[1], 1e-9 * 99e6);
  EXPECT_EQ(scan.doppler_kind, DopplerKind::kCompensated);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_TRUE(dataset->T_vehicle_sensor()->translation().isApprox(Eigen::Vector3d(0.5, 0.25, 2)));
  // The vehicle stands at (10, 0, 0), turned left: what is to its left is at the world's -x.
  EXPECT_EQ(dataset->ground_truth().size(), 2u);
  EXPECT_TRUE(dataset->ground_truth()[1].T_world_sensor.translation().isApprox(Eigen::Vector3d(10 - 0.25, 0.5, 2)));
  EXPECT_EQ(dataset->ground_truth_file(), folder_ / "sequence.json");
}

TEST_F(AevaScenes, SeveralAreMergedWithTheirOwnLinesOfSight) {
  const std::unique_ptr<Dataset> dataset = open_dataset(root_, {.sensors = {"front_wide_lidar", "left_lidar"}});
  const RawScan scan = dataset->scan(1);
  ASSERT_EQ(scan.points.size(), 4u);
  EXPECT_TRUE(scan.points[0].isApprox(Eigen::Vector3d(4.5, 4, 2)));
  EXPECT_TRUE(scan.directions[0].isApprox(Eigen::Vector3d(0.6, 0.8, 0)));
  // Turned left: 3 ahead and 4 to the left of that LiDAR is 4 back and 3 to the left of the vehicle.
  EXPECT_TRUE(scan.points[2].isApprox(Eigen::Vector3d(0.5 - 4, 0.25 + 3, 2)));
  EXPECT_TRUE(scan.directions[2].isApprox(Eigen::Vector3d(-0.8, 0.6, 0)));
  EXPECT_EQ(scan.doppler, (std::vector<double>{0.5, 0, -2, 0}));
  EXPECT_EQ(scan.times.size(), 4u);
  EXPECT_TRUE(dataset->T_vehicle_sensor()->isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(dataset->ground_truth()[1].T_world_sensor.translation().isApprox(Eigen::Vector3d(10, 0, 0)));
  // Without a line of sight, though not at the origin of the vehicle.
  Scan::Dropped dropped;
  EXPECT_EQ(Scan::from_raw(scan, &dropped).size(), 2u);
  EXPECT_EQ(dropped.zero_range, 2u);
  const std::vector<PointColumn> columns = dataset->columns(1);
  ASSERT_EQ(columns.size(), 4u);
  EXPECT_EQ(columns[0].name, "reflectivity");
  EXPECT_FALSE(columns[0].is_integer);
  EXPECT_EQ(columns[2].name, "semantic_labels_idx");
  EXPECT_EQ(columns[2].values, (std::vector<double>{1, 19, 1, 19}));
  EXPECT_EQ(columns[3].name, "lidar");
  EXPECT_EQ(columns[3].values, (std::vector<double>{0, 0, 1, 1}));
}

TEST_F(AevaScenes, ByDefaultTheFrontOnes) {
  const std::unique_ptr<Dataset> dataset = open_dataset(root_);
  EXPECT_EQ(dataset->scan(0).points.size(), 2u);
  EXPECT_EQ(dataset->scan_file(0).filename(), "front_wide_lidar_1700000000000000000.npz");
  EXPECT_TRUE(said(*dataset, "of 2 LiDARs front_wide_lidar taken"));
  EXPECT_THROW(open_dataset(root_, {.sensors = {"roof"}}), UsageError);
  EXPECT_THROW(open_dataset(root_, {.sensors = {"left_lidar", "left_lidar"}}), UsageError);
  EXPECT_THROW(open_dataset(root_, {.fields = {{"doppler", "velocity"}}}), UsageError);
}

TEST_F(AevaScenes, RawPointsArePreferredWhereThereAreBoth) {
  write_sequence(new_sequence());
  EXPECT_EQ(open_dataset(root_)->doppler_kind(), DopplerKind::kCompensated) << "the raw folder was not unpacked";
  for (const char* stamp : {"1700000000000000000", "1700000000100000000"}) {
    write_points("pointcloud_raw", std::string("front_wide_lidar_") + stamp, -20.0F);
  }
  const std::unique_ptr<Dataset> dataset = open_dataset(root_);
  EXPECT_EQ(dataset->doppler_kind(), DopplerKind::kRelative);
  EXPECT_EQ(dataset->scan(0).doppler[0], -20.0);
  EXPECT_TRUE(said(*dataset, "the raw points are taken"));
  EXPECT_EQ(open_dataset(folder_ / "pointcloud_raw")->scan(0).doppler[0], -20.0);
  const std::unique_ptr<Dataset> compensated = open_dataset(folder_ / "pointcloud_compensated");
  EXPECT_EQ(compensated->scan(0).doppler[0], 0.5);
  EXPECT_EQ(compensated->doppler_kind(), DopplerKind::kCompensated);
  EXPECT_EQ(open_dataset(folder_ / "sequence.json")->size(), 2u);
}

TEST_F(AevaScenes, BoxesAreInTheFrameOfThePoints) {
  const std::vector<AnnotatedBox> boxes = *open_dataset(root_, {.sensors = {"left_lidar"}})->boxes(0);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0].id, "b1");
  EXPECT_EQ(boxes[0].class_name, "car");
  EXPECT_EQ(boxes[0].extent, Eigen::Vector3d(4, 2, 1.5));
  // 10 m to the left of the vehicle's LiDAR, which looks left; both are turned by 90 degrees.
  EXPECT_TRUE(boxes[0].T_sensor_box.translation().isApprox(Eigen::Vector3d(10, 0, 0)));
  EXPECT_TRUE(boxes[0].T_sensor_box.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_TRUE(boxes[0].velocity_sensor.isApprox(Eigen::Vector3d(7, 0, 0)));
  EXPECT_TRUE(open_dataset(root_)->boxes(1)->empty());
  write_sequence(replaced(old_sequence(), "\"VEHICLE\"", "\"left_lidar\""));
  EXPECT_TRUE((*open_dataset(root_, {.sensors = {"left_lidar"}})->boxes(0))[0].velocity_sensor.isApprox(
      Eigen::Vector3d(0, 7, 0)));
}

TEST_F(AevaScenes, AFrameMayLackALidar) {
  write_sequence(
      replaced(old_sequence(),
               R"("front_wide_lidar": {"point_cloud_path": "pointcloud_compensated/front_wide_lidar_17000000001)",
               R"("other": {"point_cloud_path": "pointcloud_compensated/front_wide_lidar_17000000001)"));
  const std::unique_ptr<Dataset> dataset = open_dataset(root_);
  EXPECT_TRUE(dataset->scan(1).points.empty());
  EXPECT_NE(dataset->scan(1).warning.find("no points of front_wide_lidar"), std::string::npos);
  EXPECT_EQ(open_dataset(root_, {.sensors = {"front_wide_lidar", "left_lidar"}})->scan(1).points.size(), 2u);
}

TEST_F(AevaScenes, RootsOfManySequencesListThem) {
  const fs::path other = root_ / "train" / "00000000-0000-0000-0000-000000000001";
  fs::create_directories(other.parent_path());
  fs::copy(folder_, other, fs::copy_options::recursive);
  expect_message(kUuid);
  expect_message(other.string());
  EXPECT_EQ(open_dataset(root_ / "train")->size(), 2u);
}

TEST_F(AevaScenes, AFrameWithoutAPoseHasNoTruthAndItIsSaid) {
  const std::string whole = old_sequence();
  std::string one = whole;
  one.replace(one.find("\"ego_pose\""), 10, "\"no_pose\"");
  write_sequence(one);
  EXPECT_EQ(open_dataset(root_)->ground_truth().size(), 1u);
  EXPECT_TRUE(said(*open_dataset(root_), "1 of 2 frames have no ego_pose"));
  write_sequence(replaced(whole, "\"ego_pose\"", "\"no_pose\""));
  EXPECT_TRUE(open_dataset(root_)->ground_truth().empty());
  EXPECT_TRUE(open_dataset(root_)->ground_truth_file().empty());
  fs::remove(folder_ / "sequence.json");
  expect_within(fault_of_reading(folder_), "expected sequence.json beside pointcloud_compensated");
}

TEST_F(AevaScenes, WrongSequencesNameThePlace) {
  for (const std::string text : {"", "{", "[]", "{}", R"({"metadata": {}})", R"({"metadata": 7, "frames": []})"}) {
    write_sequence(text);
    expect_message((folder_ / "sequence.json").string() + ": metadata");
  }
  const auto with = [&](const std::string& what, const std::string& instead, const std::string& part) {
    ASSERT_NE(old_sequence().find(what), std::string::npos) << what;
    write_sequence(replaced(old_sequence(), what, instead));
    expect_message(part);
  };
  with("\"1700000000100000000\"", "\"1.7e18\"", "frame 0: timestamp_ns is \"1.7e18\"");
  with("\"1700000000100000000\"", "1700000000000000000", "two frames have the timestamp_ns 1700000000000000000");
  with("{\"x\": 10,", "{\"x\": \"far\",", "frame 0: ");
  with("\"w\": 0.7071067811865476", "\"w\": 7", "extrinsics of left_lidar: a pose has a quaternion of length 7.0");
  with("\"vehicle_to_lidar_extrinsics\"", "\"extrinsics\"", "metadata: expected");
  write_sequence(old_sequence().substr(0, old_sequence().find("\"frames\"")) + "\"frames\": []}");
  expect_message("no frames");
  for (const char* outside : {"/tmp/", "../", "pointcloud_compensated/../../other/"}) {
    with("pointcloud_compensated/", outside, "frame 0: point_cloud_path is '");
  }
  with("pointcloud_compensated/", "elsewhere/", "names no points of front_wide_lidar");
}

TEST_F(AevaScenes, WrongPointsNameTheFile) {
  const std::string name = "pointcloud_compensated/front_wide_lidar_1700000000000000000.npz";
  const auto expect_damage = [&](const std::vector<formats::NpzMember>& members, const std::string& part) {
    formats::write_npz(folder_ / name, members);
    expect_message((folder_ / name).string());
    expect_message(part);
  };
  const formats::NpzMember xyz = member<float>("xyz", {2, 3}, {1, 2, 3, 4, 5, 6});
  const formats::NpzMember velocity = member<float>("velocity", {2, 1}, {1, 2});
  expect_damage({xyz}, "'velocity': is missing");
  expect_damage({velocity}, "'xyz': is missing");
  expect_damage({member<float>("xyz", {3, 2}, {1, 2, 3, 4, 5, 6}), velocity}, "'xyz': has 2 columns");
  expect_damage({xyz, member<float>("velocity", {3, 1}, {1, 2, 3})},
                "has 3 x 1 values, expected one for each of the 2");
  expect_damage({xyz, velocity, member<float>("time_offset_ns", {1}, {1})}, "'time_offset_ns': has 1 x 1");
  expect_damage({xyz, velocity, member<float>("line_index", {1}, {1})}, "'line_index': has 1 x 1");
  const std::string whole = formats::read_whole_file(folder_ / name);
  formats::write_whole_file(folder_ / name, whole.substr(0, whole.size() / 2));
  expect_message(name);
  formats::write_whole_file(folder_ / name, "");
  expect_message(name);
  fs::remove(folder_ / name);
  expect_message(name);
  formats::write_npz(folder_ / name, std::vector<formats::NpzMember>{xyz, velocity});
  EXPECT_EQ(message(), "no error");
  EXPECT_TRUE(open_dataset(root_)->scan(0).times.empty());
}

}  // namespace
}  // namespace dynamic_icp::datasets
