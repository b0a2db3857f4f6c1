// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/truth_writer.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "testing/written_files.hpp"

namespace dynamic_icp::simulation {
namespace {

class TruthFiles : public WrittenFiles {
 protected:
  void write(const TruthOptions& options = {}) const { write(simulation_, options); }

  /// Without the scans that are lost.
  void write(const Simulation& simulation, const TruthOptions& options) const {
    TruthWriter writer(folder_, simulation, 0, options);
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      if (!simulation.scan_time(i).missing) {
        writer.add(simulation.frame(i, workers_));
      }
    }
    writer.finish();
  }

  struct Row {
    std::string stamp;
    Eigen::Isometry3d T;
  };

  [[nodiscard]] std::vector<Row> poses() const {
    std::istringstream text(content(folder_ / "ref_poses.txt"));
    std::vector<Row> rows;
    std::string stamp;
    double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    while (text >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw) {
      rows.push_back({stamp, Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz)});
    }
    return rows;
  }
};

TEST_F(TruthFiles, PosesAreRelativeToTheFirstScan) {
  write();
  const std::vector<Row> rows = poses();
  ASSERT_EQ(rows.size(), 4U);
  const Eigen::Isometry3d T_first_world = simulation_.sensor_state(0.0).T_world_sensor.inverse();
  EXPECT_EQ(rows[0].T.matrix(), Eigen::Matrix4d::Identity());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows[i].stamp, "0." + std::to_string(i) + "00000000");
    const Eigen::Isometry3d expected = T_first_world * simulation_.sensor()(0.1 * static_cast<double>(i)).T_world_body;
    EXPECT_LT((rows[i].T.matrix() - expected.matrix()).norm(), 5e-9);
  }
}

TEST_F(TruthFiles, VehiclePosesAndCalibrationGiveTheSensorPoses) {
  write({0, true, false});
  const auto mounting = nlohmann::json::parse(content(folder_ / "calibration.json"))["T_V_to_S"];
  const auto& q = mounting["quaternion"];
  const auto& t = mounting["translation"];
  const Eigen::Isometry3d T_vehicle_sensor =
      Eigen::Translation3d(t["x"], t["y"], t["z"]) * Eigen::Quaterniond(q["w"], q["x"], q["y"], q["z"]);
  const std::vector<Row> rows = poses();
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_TRUE(rows[0].T.isApprox(Eigen::Isometry3d::Identity(), 1e-9));
  const Eigen::Isometry3d T_first_world = simulation_.sensor_state(0.0).T_world_sensor.inverse();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Isometry3d T_first_sensor = (rows[0].T * T_vehicle_sensor).inverse() * rows[i].T * T_vehicle_sensor;
    const Eigen::Isometry3d expected = T_first_world * simulation_.sensor()(0.1 * static_cast<double>(i)).T_world_body;
    EXPECT_LT((T_first_sensor.matrix() - expected.matrix()).norm(), 2e-8);
  }
}

TEST_F(TruthFiles, MotionIsThePoseOverTime) {
  write({1'000'000'000'000'000'000, false, false});
  std::istringstream text(content(folder_ / "motion.csv"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "timestamp,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz");
  const Eigen::Isometry3d T_first_world = simulation_.sensor_state(0.0).T_world_sensor.inverse();
  int rows = 0;
  for (; std::getline(text, line); ++rows) {
    const std::int64_t stamp_ns = 5'000'000LL * rows;
    const double time_s = 1e-9 * static_cast<double>(stamp_ns);
    EXPECT_EQ(line.substr(0, line.find(',')), "1000000000." + std::to_string(1'000'000'000 + stamp_ns).substr(1));
    std::vector<double> values;
    std::istringstream fields(line.substr(line.find(',') + 1));
    for (std::string field; std::getline(fields, field, ',');) {
      values.push_back(std::stod(field));
    }
    ASSERT_EQ(values.size(), 13U);
    const world::MotionState motion = simulation_.sensor()(time_s);
    const Eigen::Isometry3d expected = T_first_world * motion.T_world_body;
    EXPECT_LT((expected.translation() - Eigen::Vector3d(values[0], values[1], values[2])).norm(), 2e-9);
    const Eigen::Vector3d velocity(values[7], values[8], values[9]);
    EXPECT_LT((motion.T_world_body.linear() * velocity - motion.velocity_world).norm(), 5e-9);
    const Eigen::Vector3d rate(values[10], values[11], values[12]);
    EXPECT_LT((motion.T_world_body.linear() * rate - motion.angular_velocity_world).norm(), 5e-9);
  }
  EXPECT_EQ(rows, 80);
}

TEST_F(TruthFiles, ObjectsAndEgoMotionAreComplete) {
  write();
  const auto objects = json_lines(folder_ / "objects.jsonl");
  const auto ego = json_lines(folder_ / "ego.jsonl");
  ASSERT_EQ(objects.size(), 4U);
  ASSERT_EQ(ego.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const SimulatedFrame frame = simulation_.frame(i, workers_);
    EXPECT_EQ(objects[i]["index"], i);
    ASSERT_EQ(objects[i]["objects"].size(), frame.objects.size());
    ASSERT_FALSE(frame.objects.empty());
    for (std::size_t k = 0; k < frame.objects.size(); ++k) {
      EXPECT_EQ(objects[i]["objects"][k]["id"], frame.objects[k].id);
      EXPECT_EQ(objects[i]["objects"][k]["points"], frame.objects[k].points);
      EXPECT_EQ(objects[i]["objects"][k]["velocity_sensor"][0], frame.objects[k].velocity_sensor.x());
      EXPECT_EQ(objects[i]["objects"][k]["center_sensor"][1], frame.objects[k].center_sensor.y());
    }
    EXPECT_EQ(ego[i]["velocity_sensor"][2], frame.sensor.velocity_sensor.z());
    EXPECT_EQ(ego[i]["angular_velocity_sensor"][0], frame.sensor.angular_velocity_sensor.x());
  }
}

TEST_F(TruthFiles, LabelsAndPointTruthFollowTheScan) {
  write({0, false, true});
  for (std::size_t i = 0; i < 4; ++i) {
    const SimulatedFrame frame = simulation_.frame(i, workers_);
    const std::string name = "0000" + std::to_string(i + 1) + ".bin";
    EXPECT_EQ(binary<std::int32_t>(folder_ / "labels" / name), frame.scan.bodies);
    const auto truth = binary<double>(folder_ / "truth" / name);
    ASSERT_EQ(truth.size(), 2 * frame.scan.bodies.size());
    for (std::size_t k = 0; k < frame.scan.bodies.size(); ++k) {
      ASSERT_EQ(truth[2 * k], frame.scan.true_range[k]);
      ASSERT_EQ(truth[2 * k + 1], frame.scan.true_doppler[k]);
    }
  }
}

TEST_F(TruthFiles, LostScansAreGapsInTimeAndNotInNumbers) {
  SimulationConfig lossy = config();
  lossy.frames = 12;
  lossy.rig.sensors.front().lidar.timing.missing_scan_rate = 0.4;
  const Simulation simulation(scenes::find_scene("street"), lossy);
  write(simulation, {});
  std::vector<std::string> stamps;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    if (!simulation.scan_time(i).missing) {
      stamps.push_back(format_seconds(simulation.stamp(i)));
    }
  }
  ASSERT_TRUE(stamps.size() > 3 && stamps.size() < 11);
  const std::vector<Row> rows = poses();
  const auto objects = json_lines(folder_ / "objects.jsonl");
  ASSERT_EQ(rows.size(), stamps.size());
  ASSERT_EQ(objects.size(), stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_EQ(rows[i].stamp, stamps[i]);
    EXPECT_EQ(objects[i]["index"], i);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "labels" / fmt::format("{:05}.bin", i + 1)));
  }
  const std::string motion = content(folder_ / "motion.csv");
  EXPECT_EQ(std::count(motion.begin(), motion.end(), '\n'), 1 + 20 * 12) << "the motion goes on";
}

TEST_F(TruthFiles, StampsThatErrComeWithTheTimeOfTheBegin) {
  SimulationConfig erring = config();
  erring.rig.sensors.front().lidar.timing.stamp_jitter_s = 0.002;
  const Simulation simulation(scenes::find_scene("street"), erring);
  write(simulation, {});
  std::istringstream text(content(folder_ / "stamps.csv"));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "index,stamp,begin");
  const std::vector<Row> rows = poses();
  const Eigen::Isometry3d T_first_world = simulation.sensor_state(0.0).T_world_sensor.inverse();
  for (std::size_t i = 0; i < 4; ++i) {
    const ScanTime time = simulation.scan_time(i);
    EXPECT_NE(time.stamp, time.begin);
    std::getline(text, line);
    EXPECT_EQ(line, fmt::format("{},{},{}", i, format_seconds(time.stamp), format_seconds(time.begin)));
    EXPECT_EQ(rows[i].stamp, format_seconds(time.stamp));
    const Eigen::Isometry3d expected = T_first_world * simulation.sensor()(0.1 * static_cast<double>(i)).T_world_body;
    EXPECT_LT((rows[i].T.matrix() - expected.matrix()).norm(), 5e-9) << "of the begin";
  }
  write();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "doppler_error"));
}

TEST_F(TruthFiles, SystematicDopplerErrorIsWrittenPerPoint) {
  SimulationConfig erring = config();
  FmcwLidarConfig& lidar = erring.rig.sensors.front().lidar;
  lidar = without_noise(lidar);
  lidar.doppler_bias_mps = 0.1;
  lidar.doppler_error.direction_mps = 0.15;
  lidar.doppler_error.drift_mps_per_sqrt_s = 0.1;
  const Simulation simulation(scenes::find_scene("street"), erring);
  write(simulation, {0, false, true});
  for (std::size_t i = 0; i < 4; ++i) {
    const SimulatedScan scan = simulation.frame(i, workers_).scan;
    const auto errors = binary<double>(folder_ / "doppler_error" / fmt::format("{:05}.bin", i + 1));
    ASSERT_EQ(errors.size(), scan.bodies.size());
    for (std::size_t k = 0; k < errors.size(); ++k) {
      ASSERT_NEAR(errors[k], scan.measured.doppler[k] - scan.true_doppler[k], 1e-9);
    }
  }
}

TEST(Labels, StandingBodiesAreStaticAndRainStaysRain) {
  SimulatedFrame frame;
  frame.scan.bodies = {3, 4, 0, kNoBody};
  ObjectTruth moving;
  moving.id = 4;
  frame.objects = {moving};
  EXPECT_EQ(labels_of(frame), (std::vector<std::int32_t>{0, 4, 0, kNoBody}));
}

}  // namespace
}  // namespace dynamic_icp::simulation
