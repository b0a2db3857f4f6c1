// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/map_writer.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

odometry::Frame frame_with(const std::vector<Vector3d>& points,
                           const Eigen::Isometry3d& T_world_sensor = Eigen::Isometry3d::Identity()) {
  odometry::Frame frame;
  frame.static_points = points;
  frame.T_world_sensor = T_world_sensor;
  return frame;
}

class MapWriterTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// The points in a map, as the reader of PLY files finds them.
  [[nodiscard]] std::vector<Vector3d> points_of(const MapWriter& map) const {
    map.write(folder_ / "map.ply");
    const formats::PlyFile file = formats::read_ply(folder_ / "map.ply");
    const formats::PlyElement& vertex = *file.find("vertex");
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < vertex.count; ++i) {
      points.emplace_back(vertex.find("x")->values[i], vertex.find("y")->values[i], vertex.find("z")->values[i]);
    }
    return points;
  }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_ = fs::temp_directory_path() / ("map_writer_test-" + std::to_string(::getpid()));
};

TEST_F(MapWriterTest, NothingMakesAnEmptyMap) {
  MapWriter map(0.1);
  map.add(frame_with({}));
  EXPECT_EQ(map.size(), 0u);
  EXPECT_TRUE(points_of(map).empty());
  map.write(folder_ / "map.pcd");
  EXPECT_EQ(formats::read_whole_file(folder_ / "map.pcd"), formats::pcd_bytes(formats::point_table({})));
}

// A quarter turn to the left and ten metres ahead, all numbers exact in float32.
TEST_F(MapWriterTest, PointsLieInTheWorld) {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  T_world_sensor.linear() << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  T_world_sensor.translation() = Vector3d(10.0, 0.0, 0.5);
  MapWriter map(0.1);
  map.add(frame_with({{2.0, 3.0, 4.0}}, T_world_sensor));
  EXPECT_EQ(points_of(map), (std::vector<Vector3d>{{7.0, 2.0, 4.5}}));
  EXPECT_EQ(map.points(), points_of(map));
}

TEST_F(MapWriterTest, EachVoxelKeepsItsFirstPoint) {
  MapWriter map(1.0);
  map.add(frame_with({{0.25, 0.5, 0.5}, {0.75, 0.5, 0.5}}));
  map.add(frame_with({{0.5, 0.5, 0.5}, {-0.25, 0.5, 0.5}, {1.0, 0.5, 0.5}}));
  EXPECT_EQ(map.size(), 3u);
  EXPECT_EQ(points_of(map), (std::vector<Vector3d>{{0.25, 0.5, 0.5}, {-0.25, 0.5, 0.5}, {1.0, 0.5, 0.5}}));
}

/// A frame with a car whose motion is known; `centre` of its box, m.
odometry::Frame frame_with_car(const std::vector<Vector3d>& points, const Vector3d& centre, int scans_seen) {
  odometry::Frame frame = frame_with(points);
  tracking::TrackedObject car;
  car.scans_seen = scans_seen;
  car.tangential_observed = true;
  car.velocity_sensor = {8.0, 0.0, 0.0};
  car.box = {centre, Eigen::Matrix3d::Identity(), {4.0, 2.0, 1.5}};
  frame.tracked.push_back(car);
  return frame;
}

TEST_F(MapWriterTest, WhereAnObjectDrivesNothingStands) {
  // What the car left before it began to move goes; the road below it stays, and what is beside it.
  const Vector3d ghost(10.0, 0.5, 1.0);
  const Vector3d road(10.0, 0.5, 0.05);
  const Vector3d beside(10.0, 1.5, 1.0);
  const Vector3d ahead(14.0, 0.0, 1.0);
  MapWriter map(0.1);
  map.add(frame_with({ghost, road, beside, ahead}));
  map.add(frame_with_car({}, {10.0, 0.0, 0.75}, 1));
  EXPECT_EQ(map.size(), 4u) << "seen once, it may be no object";
  map.add(frame_with_car({}, {10.0, 0.0, 0.75}, 3));
  EXPECT_EQ(map.size(), 3u);
  const std::vector<Vector3d> points = points_of(map);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_TRUE(points[0].isApprox(road, 1e-6));
  EXPECT_TRUE(points[1].isApprox(beside, 1e-6));
  EXPECT_TRUE(points[2].isApprox(ahead, 1e-6));
  // Of its own scan nothing is kept where it is.
  map.add(frame_with_car({{13.0, 0.0, 1.0}}, {13.0, 0.0, 0.75}, 4));
  EXPECT_EQ(map.size(), 2u) << "what stood ahead is gone, too";
  // A car that halts is the same car; another that stands may be a wall.
  odometry::Frame halted = frame_with_car({{20.0, 0.0, 1.0}}, {20.0, 0.0, 0.75}, 5);
  halted.tracked.front().velocity_sensor.setZero();
  odometry::Frame other = frame_with_car({{30.0, 0.0, 1.0}}, {30.0, 0.0, 0.75}, 5);
  other.tracked.front().velocity_sensor.setZero();
  other.tracked.front().id = halted.tracked.front().id + 1;
  map.add(frame_with({{20.0, 0.0, 1.0}, {30.0, 0.0, 1.0}}));
  map.add(frame_with_car({}, {13.0, 0.0, 0.75}, 5));
  EXPECT_EQ(map.size(), 4u);
  map.add(halted);
  EXPECT_EQ(map.size(), 3u);
  map.add(other);
  EXPECT_EQ(map.size(), 3u);
}

TEST_F(MapWriterTest, WhatIsInTheBoxOfAnObjectIsOfIt) {
  const Vector3d sill(11.5, 0.9, 0.1);  // as low as the road
  const Vector3d road(11.5, 0.9, 0.02);
  MapWriter map(0.05);
  map.add(frame_with_car({sill, road}, {10.0, 0.0, 0.75}, 1));
  ASSERT_EQ(map.size(), 1u);
  EXPECT_TRUE(points_of(map)[0].isApprox(road, 1e-6));
  map.add(frame_with({sill}));
  EXPECT_EQ(map.size(), 2u) << "the car is gone, something else is there";
}

// A car at 2 m/s passes for static in four scans and is known in the fifth. The sensor has turned left.
TEST_F(MapWriterTest, WhatAnObjectLeftBeforeItWasKnownGoesToo) {
  const auto scan = [](int tenths) {
    const Vector3d rear(10.0 + 0.2 * tenths, 0.5, 1.0);
    const Vector3d parked(8.4, 0.5, 1.0);  // behind it, seen from the first scan on
    odometry::Frame frame = frame_with_car({rear, parked}, rear + Vector3d(2.0, -0.5, -0.25), tenths);
    frame.stamp = Stamp{5'000'000'000 + 100'000'000 * std::int64_t{tenths}};
    frame.T_world_sensor.linear() << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    frame.tracked.front().velocity_sensor = {2.0, 0.0, 0.0};
    if (tenths < 14) {
      frame.tracked.clear();
    } else {
      frame.static_points.erase(frame.static_points.begin());
    }
    return frame;
  };
  MapWriter map(0.1);
  for (const int tenths : {1, 11, 12, 13}) {
    map.add(scan(tenths));
  }
  EXPECT_EQ(map.size(), 5u);
  map.add(scan(14));
  const std::vector<Vector3d> points = points_of(map);
  ASSERT_EQ(points.size(), 2u) << "what it left within the last second is gone";
  EXPECT_TRUE(points[0].isApprox(Vector3d(-0.5, 10.2, 1.0), 1e-6));
  EXPECT_TRUE(points[1].isApprox(Vector3d(-0.5, 8.4, 1.0), 1e-6));
}

TEST_F(MapWriterTest, EqualsTheDirectDefinitionAndDoesNotGrowInAKnownScene) {
  constexpr double kEdge_m = 0.3;
  std::mt19937 bits(3);
  const auto coordinate = [&] { return (static_cast<double>(bits()) / 4294967296.0 - 0.5) * 6.0; };
  std::vector<Vector3d> points(4000);
  for (Vector3d& point : points) {
    point = {coordinate(), coordinate(), coordinate()};
  }
  std::set<std::array<double, 3>> taken;
  std::vector<Vector3d> expected;
  for (const Vector3d& point : points) {
    if (taken
            .insert({std::floor(point.x() / kEdge_m), std::floor(point.y() / kEdge_m), std::floor(point.z() / kEdge_m)})
            .second) {
      expected.push_back(point.cast<float>().cast<double>());
    }
  }
  MapWriter map(kEdge_m);
  for (int round = 0; round < 3; ++round) {
    map.add(frame_with(points));
    EXPECT_EQ(map.size(), expected.size());
  }
  EXPECT_EQ(points_of(map), expected);
}

TEST_F(MapWriterTest, TheEndingChoosesTheFormat) {
  const std::vector<Vector3d> points = {{1.0, 2.0, 3.0}, {-4.0, 5.0, 0.5}};
  MapWriter map(0.1);
  map.add(frame_with(points));
  map.write(folder_ / "map.ply");
  map.write(folder_ / "map.pcd");
  EXPECT_EQ(formats::read_whole_file(folder_ / "map.ply"), formats::ply_bytes(formats::point_table(points)));
  EXPECT_EQ(formats::read_whole_file(folder_ / "map.pcd"), formats::pcd_bytes(formats::point_table(points)));
  for (const char* name : {"map", "map.txt", "map.ply.gz", ".ply", "map.PLY", ""}) {
    EXPECT_THROW(check_map_file(name), UsageError) << name;
    EXPECT_THROW(map.write(folder_ / name), UsageError) << name;
  }
  EXPECT_EQ(files(), 2);
}

TEST_F(MapWriterTest, RefusesVoxelsOutOfRange) {
  for (const double edge_m : {0.0, -0.1, 0.009, 101.0, kNan}) {
    EXPECT_THROW(MapWriter{edge_m}, UsageError) << edge_m;
  }
  EXPECT_NO_THROW(MapWriter{MapWriter::kMinVoxelSize_m});
  EXPECT_NO_THROW(MapWriter{MapWriter::kMaxVoxelSize_m});
}

TEST_F(MapWriterTest, RefusesPointsThatNoVoxelHolds) {
  MapWriter map(0.01);
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1.1e7}) {
    odometry::Frame frame = frame_with({{1.0, 1.0, 1.0}, {0.0, bad, 0.0}});
    frame.stamp = Stamp{12'500'000'000};
    try {
      map.add(frame);
      FAIL() << bad;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find("12.500000000 s"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(map.size(), 0u);
  EXPECT_NO_THROW(map.add(frame_with({{0.0, 1.0e7, 0.0}}))) << "10,000 km";
}

TEST_F(MapWriterTest, AFailureLeavesTheEarlierFileAndNothingElse) {
  MapWriter map(0.1);
  map.add(frame_with({{1.0, 2.0, 3.0}}));
  fs::create_directories(folder_ / "folder.ply" / "full");
  EXPECT_THROW(map.write(folder_ / "folder.ply"), DataError);
  EXPECT_THROW(map.write(folder_ / "missing" / "map.ply"), DataError);
  EXPECT_EQ(files(), 1);
}

TEST_F(MapWriterTest, AMapWithinTheRunWaitsInItsStaging) {
  const fs::path output = folder_ / "out";
  const fs::path staging = folder_ / ".out.partial";
  fs::create_directories(staging);
  EXPECT_EQ(map_destination(output / "map.ply", output, staging), staging / "map.ply");
  EXPECT_EQ(map_destination(output / "map.ply", output / "", staging), staging / "map.ply");
  EXPECT_EQ(map_destination(folder_ / "x" / ".." / "out" / "a" / "map.ply", output, staging),
            staging / "a" / "map.ply");
  EXPECT_TRUE(fs::is_directory(staging / "a"));
  EXPECT_EQ(map_destination(folder_ / "map.ply", output, staging), folder_ / "map.ply");
  EXPECT_EQ(map_destination(folder_ / "out.ply", output, staging), folder_ / "out.ply");
  EXPECT_EQ(map_destination("map.ply", output, staging), "map.ply") << "of the working directory";
  EXPECT_THROW(map_destination(folder_ / "no" / "map.ply", output, staging), DataError);
  fs::create_directory(folder_ / "folder.ply");
  EXPECT_THROW(map_destination(folder_ / "folder.ply", output, staging), DataError);
  EXPECT_THROW(map_destination(output, output, staging), UsageError);
  EXPECT_THROW(map_destination(output / "", output, staging), UsageError);
  fs::create_directory_symlink(output, folder_ / "link");
  fs::create_directories(output);
  EXPECT_EQ(map_destination(folder_ / "link" / "map.ply", output, staging), staging / "map.ply");
}

}  // namespace
}  // namespace dynamic_icp::runs
