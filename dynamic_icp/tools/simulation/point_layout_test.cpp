// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/point_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/npz_by_hand.hpp"
#include "testing/written_files.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using formats::number_in;

class PointLayouts : public WrittenFiles {
 protected:
  /// Writes the simulation of the fixture.
  void write(const std::unique_ptr<PointLayout>& layout) const {
    for (std::size_t i = 0; i < simulation_.size(); ++i) {
      layout->add(simulation_.frame(i, workers_), 0);
    }
    layout->finish();
  }

  [[nodiscard]] std::size_t files_in(const fs::path& folder) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / folder), fs::directory_iterator()));
  }
};

/// A scan whose points have these times.
SimulatedFrame frame_of_times(std::size_t index, std::vector<double> times) {
  SimulatedFrame frame;
  frame.index = index;
  frame.scan.measured.points.assign(times.size(), Eigen::Vector3d::UnitX());
  frame.scan.measured.doppler.assign(times.size(), 0.0);
  frame.scan.measured.times = std::move(times);
  return frame;
}

TEST_F(PointLayouts, DicpHoldsPointsDopplerAndTimes) {
  write(make_dicp_layout(folder_, true));
  for (std::size_t i = 0; i < simulation_.size(); ++i) {
    const RawScan scan = simulation_.frame(i, workers_).scan.measured;
    const std::string name = "0000" + std::to_string(i + 1) + ".bin";
    const auto values = binary<float>(folder_ / "point_clouds" / name);
    const auto times = binary<float>(folder_ / "times" / name);
    ASSERT_EQ(values.size(), 4 * scan.points.size());
    ASSERT_EQ(times.size(), scan.points.size());
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Eigen::Vector3d p(values[4 * k], values[4 * k + 1], values[4 * k + 2]);
      ASSERT_LT((p - scan.points[k]).norm(), 3e-5);
      ASSERT_NEAR(values[4 * k + 3], scan.doppler[k], 1e-5);
      ASSERT_NEAR(times[k], scan.times[k], 1e-8);
    }
  }
}

TEST_F(PointLayouts, DicpHasNoTimesForInstantScans) {
  write(make_dicp_layout(folder_, false));
  EXPECT_EQ(files_in("point_clouds"), simulation_.size());
  EXPECT_FALSE(fs::exists(folder_ / "times"));
}

TEST_F(PointLayouts, HerculesRecordsHoldTheScan) {
  write(make_hercules_layout(folder_));
  EXPECT_EQ(files_in(fs::path("LiDAR") / "Aeva"), simulation_.size());
  for (std::size_t i = 0; i < simulation_.size(); ++i) {
    const SimulatedScan scan = simulation_.frame(i, workers_).scan;
    const std::string bytes = content(folder_ / "LiDAR" / "Aeva" / ("1735689600" + std::to_string(i) + "00000000.bin"));
    ASSERT_EQ(bytes.size(), 29 * scan.bodies.size());
    for (std::size_t k = 0; k < scan.bodies.size(); ++k) {
      const std::size_t at = 29 * k;
      const Eigen::Vector3d p(number_in<float>(bytes, at), number_in<float>(bytes, at + 4),
                              number_in<float>(bytes, at + 8));
      ASSERT_LT((p - scan.measured.points[k]).norm(), 3e-5);
      ASSERT_FLOAT_EQ(number_in<float>(bytes, at + 12), 100.0F * scan.reflectivity[k]);
      ASSERT_NEAR(number_in<float>(bytes, at + 16), scan.measured.doppler[k], 1e-5);
      ASSERT_NEAR(number_in<std::int32_t>(bytes, at + 20), 1e9 * scan.measured.times[k], 0.5 + 1e-6);
      ASSERT_EQ(number_in<std::uint8_t>(bytes, at + 24), scan.lines[k]);
      ASSERT_EQ(number_in<float>(bytes, at + 25), scan.intensity_db[k]);
    }
  }
}

TEST_F(PointLayouts, HerculesPosesAreRelativeToTheFirstScan) {
  write(make_hercules_layout(folder_));
  std::istringstream rows(content(folder_ / "PR_GT" / "Aeva_gt.txt"));
  const Eigen::Isometry3d T_first_world = simulation_.frame(0, workers_).sensor.T_world_sensor.inverse();
  std::size_t count = 0;
  for (std::string stamp; rows >> stamp; ++count) {
    double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    rows >> x >> y >> z >> qx >> qy >> qz >> qw;
    EXPECT_TRUE(fs::exists(folder_ / "LiDAR" / "Aeva" / (stamp + ".bin"))) << stamp;
    const Eigen::Isometry3d T = Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz);
    const Eigen::Isometry3d expected = T_first_world * simulation_.frame(count, workers_).sensor.T_world_sensor;
    EXPECT_LT((T.matrix() - expected.matrix()).norm(), 5e-9);
    if (count == 0) {
      EXPECT_EQ(T.matrix(), Eigen::Matrix4d::Identity());
    }
  }
  EXPECT_EQ(count, simulation_.size());
}

// Stamps of 2023, the Doppler compensated, and records without the intensity; all else as in HeRCULES.
TEST_F(PointLayouts, HeliprRecordsAreThoseOfHerculesCompensatedWithoutTheirEnd) {
  constexpr double kStep_s = 1e-4;
  write(make_helipr_layout(folder_, simulation_));
  write(make_hercules_layout(folder_ / "hercules"));
  EXPECT_EQ(files_in(fs::path("LiDAR") / "Aeva"), simulation_.size());
  for (std::size_t i = 0; i < simulation_.size(); ++i) {
    const std::string name = std::to_string(i) + "00000000.bin";
    const std::string bytes = content(folder_ / "LiDAR" / "Aeva" / ("1685577600" + name));
    const std::string longer = content(folder_ / "hercules" / "LiDAR" / "Aeva" / ("1735689600" + name));
    ASSERT_FALSE(bytes.empty());
    ASSERT_EQ(bytes.size() / 25 * 29, longer.size());
    for (std::size_t k = 0; 25 * k < bytes.size(); ++k) {
      ASSERT_EQ(bytes.substr(25 * k, 16), longer.substr(29 * k, 16));
      ASSERT_EQ(bytes.substr(25 * k + 20, 5), longer.substr(29 * k + 20, 5));
      // The velocity by two poses.
      const double time_s = 0.1 * static_cast<double>(i) + 1e-9 * number_in<std::int32_t>(bytes, 25 * k + 20);
      const auto pose = [&](double t) { return simulation_.sensor_state(t, 0).T_world_sensor; };
      const Eigen::Vector3d moved = pose(time_s + kStep_s).translation() - pose(time_s - kStep_s).translation();
      const Eigen::Vector3d velocity = pose(time_s).linear().transpose() * moved / (2.0 * kStep_s);
      const Eigen::Vector3d p(number_in<float>(bytes, 25 * k), number_in<float>(bytes, 25 * k + 4),
                              number_in<float>(bytes, 25 * k + 8));
      ASSERT_NEAR(number_in<float>(bytes, 25 * k + 16),
                  number_in<float>(longer, 29 * k + 16) + p.normalized().dot(velocity), 1e-4);
    }
  }
  std::istringstream rows(content(folder_ / "LiDAR_GT" / "Aeva_gt.txt"));
  std::istringstream hercules_rows(content(folder_ / "hercules" / "PR_GT" / "Aeva_gt.txt"));
  for (std::string row, other; std::getline(hercules_rows, other);) {
    ASSERT_TRUE(std::getline(rows, row));
    EXPECT_EQ(row.substr(0, 10), "1685577600");
    EXPECT_EQ(row.substr(10), other.substr(10));
  }
}

TEST_F(PointLayouts, BoreasRecordsAreTenFloats) {
  SimulationConfig config = WrittenFiles::config();
  config.rig.sensors.front().lidar.beams = 4;
  config.rig.sensors.front().lidar.faces = 6;
  const Simulation simulation(scenes::find_scene("street"), config);
  const auto layout = make_boreas_layout(folder_);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    layout->add(simulation.frame(i, workers_), 0);
  }
  EXPECT_EQ(files_in("aeva"), simulation.size());
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const SimulatedScan scan = simulation.frame(i, workers_).scan;
    const auto values = binary<float>(folder_ / "aeva" / ("1735689600" + std::to_string(i) + "00000.bin"));
    ASSERT_EQ(values.size(), 10 * scan.bodies.size());
    for (std::size_t k = 0; k < scan.bodies.size(); ++k) {
      const float* const record = &values[10 * k];
      const Eigen::Vector3d p(record[0], record[1], record[2]);
      ASSERT_LT((p - scan.measured.points[k]).norm(), 3e-5);
      ASSERT_NEAR(record[3], scan.measured.doppler[k], 1e-5);
      ASSERT_EQ(record[4], scan.intensity_db[k]);
      ASSERT_EQ(record[5], 1.0F);
      ASSERT_FLOAT_EQ(record[6], 100.0F * scan.reflectivity[k]);
      ASSERT_NEAR(record[7], 1e9 * scan.measured.times[k], 4.0 + 0.5) << "steps of 8 ns";
      const auto flags = static_cast<unsigned>(record[8]);
      ASSERT_EQ((flags >> 8U) & 0xFFU, scan.lines[k]);
      ASSERT_EQ((flags >> 16U) & 0xFU, scan.lines[k] % 4U);
      ASSERT_EQ((flags >> 22U) & 0xFU, scan.faces[k]);
      ASSERT_EQ(record[9], 0.0F);
    }
  }
}

// The published product of the elementary matrices, written out.
TEST_F(PointLayouts, BoreasPosesTurnTheAxes) {
  write(make_boreas_layout(folder_));
  std::istringstream rows(content(folder_ / "applanix" / "aeva_poses.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row.substr(0, 30), "GPSTime,easting,northing,altit");
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (; std::getline(rows, row); ++count) {
    const std::string stamp = row.substr(0, 16);
    EXPECT_TRUE(fs::exists(folder_ / "aeva" / (stamp + ".bin"))) << stamp;
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream numbers(row.substr(16));
    std::vector<double> v(12);
    for (double& number : v) {
      numbers >> number;
    }
    const double cr = std::cos(v[6]), sr = std::sin(v[6]);
    const double cp = std::cos(v[7]), sp = std::sin(v[7]);
    const double cy = std::cos(v[8]), sy = std::sin(v[8]);
    Eigen::Matrix3d Rx, Ry, Rz;
    Rx << 1, 0, 0, 0, cr, sr, 0, -sr, cr;
    Ry << cp, 0, -sp, 0, 1, 0, sp, 0, cp;
    Rz << cy, sy, 0, -sy, cy, 0, 0, 0, 1;
    const SensorState truth = simulation_.frame(count, workers_).sensor;
    EXPECT_LT((Rx * Ry * Rz - truth.T_world_sensor.linear()).norm(), 1e-11);
    const Eigen::Vector3d position(v[0], v[1], v[2]);
    origin = count == 0 ? Eigen::Vector3d(position - truth.T_world_sensor.translation()) : origin;
    EXPECT_GT(origin.norm(), 1e5);
    EXPECT_LT((position - origin - truth.T_world_sensor.translation()).norm(), 5e-9);
    EXPECT_LT((truth.T_world_sensor.linear() * truth.velocity_sensor - Eigen::Vector3d(v[3], v[4], v[5])).norm(), 1e-8);
    EXPECT_NEAR(v[9], truth.angular_velocity_sensor.z(), 1e-9);
    EXPECT_NEAR(v[11], truth.angular_velocity_sensor.x(), 1e-9);
  }
  EXPECT_EQ(count, simulation_.size());
}

TEST_F(PointLayouts, BoreasRefusesWhatDoesNotFit) {
  SimulatedFrame frame = frame_of_times(0, {0.0});
  frame.sensor = simulation_.frame(0, workers_).sensor;
  frame.scan.reflectivity = {0.5F};
  frame.scan.intensity_db = {-20.0F};
  frame.scan.lines = {255};
  frame.scan.beams = {0};
  frame.scan.faces = {0};
  const auto layout = make_boreas_layout(folder_);
  EXPECT_NO_THROW(layout->add(frame, 0));
  frame.scan.measured.stamp.ns = 83'333'333;
  EXPECT_THROW(layout->add(frame, 0), UsageError);
  frame.scan.measured.stamp.ns = 83'333'000;
  frame.scan.lines = {256};
  EXPECT_THROW(layout->add(frame, 0), UsageError);
}

TEST_F(PointLayouts, HerculesRefusesLinesThatDoNotFit) {
  SimulatedFrame frame = frame_of_times(0, {0.0});
  frame.sensor.T_world_sensor.setIdentity();
  frame.scan.reflectivity = {0.5F};
  frame.scan.intensity_db = {-20.0F};
  frame.scan.lines = {255};
  const auto layout = make_hercules_layout(folder_);
  EXPECT_NO_THROW(layout->add(frame, 0));
  frame.scan.lines = {256};
  EXPECT_THROW(layout->add(frame, 0), UsageError);
}

TEST_F(PointLayouts, FailuresNameTheFile) {
  std::ofstream(folder_ / "file") << "a file where a folder must be";
  const auto expect_fault = [](const auto& action, const std::string& name) {
    try {
      action();
      FAIL() << name;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  expect_fault([&] { make_dicp_layout(folder_ / "file", false); }, "point_clouds");
  expect_fault([&] { make_hercules_layout(folder_ / "file"); }, "PR_GT");
  expect_fault([&] { make_helipr_layout(folder_ / "file", simulation_); }, "LiDAR_GT");
  expect_fault([&] { make_boreas_layout(folder_ / "file"); }, "applanix");
  expect_fault([&] { make_aevascenes_layout(folder_ / "file", simulation_); }, "pointcloud_raw");
  const auto layout = make_aevascenes_layout(folder_, simulation_);
  fs::remove_all(folder_ / "pointcloud_compensated");
  expect_fault([&] { layout->add(simulation_.frame(0, workers_), 0); }, "1735689600000000000.npz: cannot create");
}

}  // namespace
}  // namespace dynamic_icp::simulation
