// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the layouts of data sets say of each point, and whether it is still said after a conversion.
#include <functional>

#include "dynamic_icp/recording/conversion/conversion.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"

#include "testing/recording_by_hand.hpp"

namespace dynamic_icp::conversion {
namespace {

namespace fs = std::filesystem;
using datasets::Dataset;
using datasets::floats;
using datasets::open_dataset;

constexpr int kPoints = 60;

std::string many(const std::function<std::string(int)>& record) {
  std::string bytes;
  for (int i = 0; i < kPoints; ++i) {
    bytes += record(i);
  }
  return bytes;
}

std::string start_of(int i) { return floats({static_cast<float>(i), 2, 3}); }

/// Whether nothing is said of the points but what their positions and Doppler are.
bool is_silent(const RawScan& scan) {
  return scan.channels.sensor.empty() && scan.channels.line.empty() && scan.channels.face.empty() &&
         scan.channels.intensity.empty() && scan.channels.return_number.empty() && scan.is_unusable.empty() &&
         scan.mountings.empty();
}

void expect_same(const RawScan& scan, const RawScan& original) {
  EXPECT_EQ(scan.points, original.points);
  EXPECT_EQ(scan.directions, original.directions);
  EXPECT_EQ(scan.channels.sensor, original.channels.sensor);
  EXPECT_EQ(scan.channels.line, original.channels.line);
  EXPECT_EQ(scan.channels.face, original.channels.face);
  EXPECT_EQ(scan.channels.intensity, original.channels.intensity);
  EXPECT_EQ(scan.channels.return_number, original.channels.return_number);
  EXPECT_EQ(scan.is_unusable, original.is_unusable);
  ASSERT_EQ(scan.mountings.size(), original.mountings.size());
  for (std::size_t k = 0; k < scan.mountings.size(); ++k) {
    EXPECT_TRUE(scan.mountings[k].isApprox(original.mountings[k], 1e-14));
  }
}

class Channels : public datasets::RecordingByHand {
 protected:
  /// The first scan of the recording, after what a conversion into each layout with named columns makes of it was
  /// found to be the same.
  RawScan converted_scan() {
    const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
    RawScan original = dataset->scan(0);
    EXPECT_FALSE(is_silent(original));
    for (const auto& [name, target] :
         {std::pair("npz", Target::kNpz), {"pcd", Target::kPcd}, {"ply", Target::kPly}, {"mcap", Target::kMcap}}) {
      SCOPED_TRACE(name);
      const fs::path out = above_ / name;
      fs::create_directories(out);
      const std::vector<std::string> notes = convert(*dataset, {0, 1}, target, out);
      EXPECT_TRUE(std::none_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.find("left out") != std::string::npos && note.find("compensated") == std::string::npos;
      }));
      const std::unique_ptr<Dataset> converted = open_dataset(out);
      EXPECT_EQ(converted->format(), name);
      expect_same(converted->scan(0), original);
      EXPECT_EQ(converted->T_vehicle_sensor().has_value(), dataset->T_vehicle_sensor().has_value());
    }
    const fs::path plain = above_ / "dicp";
    fs::create_directories(plain);
    const std::vector<std::string> notes = convert(*dataset, {0, 1}, Target::kDicp, plain);
    EXPECT_TRUE(is_silent(open_dataset(plain)->scan(0)));
    for (const datasets::PointColumn& column : dataset->columns(0)) {
      const std::string note = "column '" + column.name + "' is left out: dicp has no place for it";
      EXPECT_NE(std::find(notes.begin(), notes.end(), note), notes.end()) << note;
    }
    return original;
  }
};

TEST_F(Channels, OfHercules) {
  write("LiDAR/Aeva/1724479779384729506.bin",
        many([](int i) { return datasets::aeva_record(1.0F + static_cast<float>(i), 2, 3, -4, 1000 * i, 127); }));
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.channels.line.at(59), 127);
  EXPECT_EQ(scan.channels.intensity.at(59), -57.0F) << "not the reflectivity";
}

TEST_F(Channels, OfHeliprWithoutIntensity) {
  write("LiDAR/Aeva/1690000000000000000.bin", many([](int i) {
          return datasets::aeva_record(1.0F + static_cast<float>(i), 2, 3, -4, 1000 * i, 9).substr(0, 25);
        }));
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.channels.line.at(59), 9);
  EXPECT_EQ(scan.channels.intensity.at(59), 20.5F) << "the reflectivity";
}

TEST_F(Channels, OfBoreasRt) {
  write("calib/camera.txt", "");
  write("aeva/1724479779384729.bin", many([](int i) {
          const int flags = (i % 64) << 8 | (i % 4) << 16 | (i % 6) << 22;
          return start_of(i + 1) + floats({-4, 11.5F, 1, 13, 1000.0F * static_cast<float>(i)}) +
                 floats({static_cast<float>(flags), 0});
        }));
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.channels.line.at(59), 59);
  EXPECT_EQ(scan.channels.face.at(59), 5);
  EXPECT_EQ(scan.channels.intensity.at(59), 11.5F);
}

TEST_F(Channels, OfBoreasAeva) {
  write("calib/camera.txt", "");
  write("aeva/1660000000000000.bin", many([](int i) {
          return start_of(i + 1) + floats({11.5F, -4, 0.0015F * static_cast<float>(i), static_cast<float>(i % 4), 1});
        }));
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.channels.line.at(59), 3);
  EXPECT_EQ(scan.channels.sensor.at(59), 1);
  EXPECT_TRUE(scan.channels.face.empty());
}

TEST_F(Channels, OfTheRadarOfViewOfDelft) {
  write("training/velodyne/00544.bin", many([](int i) {
          const auto x = static_cast<float>(i);
          return start_of(i + 1) +
                 floats({-20.0F + 0.5F * x, -0.1F * x, i % 2 == 0 ? 0.5F : -0.5F, i < 30 ? 0.0F : -1.0F});
        }));
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.doppler.at(20), static_cast<double>(-0.1F * 20.0F)) << "v_r";
  EXPECT_EQ(scan.channels.intensity.at(59), 9.5F);
  EXPECT_EQ(scan.is_unusable.at(29), 0);
  EXPECT_EQ(scan.is_unusable.at(30), 1) << "of an earlier scan";
  EXPECT_TRUE(scan.times.empty());
}

/// Two LiDARs, the second turned left; what each has of its points.
void write_rig(const fs::path& folder) {
  using formats::npy_array;
  using formats::NpzMember;
  for (const char* lidar : {"front_narrow_lidar", "front_wide_lidar"}) {
    const float reflectivity = lidar[6] == 'n' ? 7.5F : 8191.0F;
    fs::create_directories(folder / "pointcloud_raw");
    formats::write_npz(
        folder / "pointcloud_raw" / (std::string(lidar) + ".npz"),
        std::vector<NpzMember>{
            {"xyz", npy_array<float>({2, 3}, std::vector<float>{3, 4, 0, 5, 6, 7})},
            {"velocity", npy_array<float>({2, 1}, std::vector<float>{0.5F, -1})},
            {"reflectivity", npy_array<float>({2, 1}, std::vector<float>{reflectivity, 1})},
            {"line_index", npy_array<std::uint32_t>({2, 1}, std::vector<std::uint32_t>{63, 300})},
            {"time_offset_ns", npy_array<std::uint32_t>({2}, std::vector<std::uint32_t>{0, 99'000'000})}});
  }
}

TEST_F(Channels, OfARig) {
  write_rig(folder_);
  write("sequence.json", R"({"metadata": {"sensors": {"lidars": ["front_wide_lidar", "front_narrow_lidar"]},
    "vehicle_to_lidar_extrinsics": {
      "front_wide_lidar": {"translation": {"x": 1.5, "y": 0, "z": 2}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}},
      "front_narrow_lidar": {"translation": {"x": 0.5, "y": 0.25, "z": 2}, "rotation": {"w": 0.6, "x": 0, "y": 0, "z": 0.8}}}},
    "frames": [{"timestamp_ns": 1700000000000000000, "frame_idx": 0, "boxes": [],
      "ego_pose": {"translation": {"x": 0, "y": 0, "z": 0}, "rotation": {"w": 1, "x": 0, "y": 0, "z": 0}},
      "point_cloud": {
        "front_wide_lidar": {"point_cloud_raw_path": "pointcloud_raw/front_wide_lidar.npz"},
        "front_narrow_lidar": {"point_cloud_raw_path": "pointcloud_raw/front_narrow_lidar.npz"}}}]})");
  const std::unique_ptr<Dataset> dataset = open_dataset(folder_);
  RawScan scan = dataset->scan(0);
  EXPECT_EQ(scan.channels.sensor, (std::vector<std::uint8_t>{0, 0, 1, 1}));
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{63, 300, 63, 300}));
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{8191, 1, 7.5F, 1}));
  ASSERT_EQ(scan.mountings.size(), 2U);
  // A point of the second LiDAR by its mounting.
  EXPECT_TRUE(scan.points[2].isApprox(scan.mountings[1] * Eigen::Vector3d(3, 4, 0), 1e-12));
  EXPECT_TRUE(scan.directions[2].isApprox(scan.mountings[1].linear() * Eigen::Vector3d(0.6, 0.8, 0), 1e-12));
  for (const auto& [name, target] :
       {std::pair("npz", Target::kNpz), {"pcd", Target::kPcd}, {"ply", Target::kPly}, {"mcap", Target::kMcap}}) {
    SCOPED_TRACE(name);
    fs::create_directories(above_ / name);
    convert(*dataset, {0, 1}, target, above_ / name);
    expect_same(open_dataset(above_ / name)->scan(0), scan);
  }
  const RawScan alone = open_dataset(folder_, {.sensors = {"front_narrow_lidar"}})->scan(0);
  EXPECT_TRUE(alone.channels.sensor.empty() && alone.mountings.empty());
  EXPECT_EQ(alone.channels.line, (std::vector<std::uint16_t>{63, 300}));
}

TEST_F(Channels, OfNamedColumns) {
  write(
      "1.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float range_rate\nproperty uint nanosecs_since_frame\nproperty uchar Ring\nproperty uchar sensor_id\n"
      "property uchar face\nproperty float rcs\nproperty uchar echo\nproperty uchar valid\nproperty uint drop_reason\n"
      "end_header\n1 2 3 -4 0 5 1 2 -7.5 0 1 0\n4 5 6 -7 50000000 6 0 3 8 1 1 4\n");
  const RawScan scan = converted_scan();
  EXPECT_EQ(scan.doppler, (std::vector<double>{-4, -7}));
  EXPECT_DOUBLE_EQ(scan.times.at(1), 0.05);
  EXPECT_EQ(scan.channels.line, (std::vector<std::uint16_t>{5, 6}));
  EXPECT_EQ(scan.channels.sensor, (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(scan.channels.face, (std::vector<std::uint8_t>{2, 3}));
  EXPECT_EQ(scan.channels.intensity, (std::vector<float>{-7.5F, 8}));
  EXPECT_EQ(scan.channels.return_number, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(scan.is_unusable, (std::vector<std::uint8_t>{0, 1}));
}

}  // namespace
}  // namespace dynamic_icp::conversion
