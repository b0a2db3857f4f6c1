// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/sequence_writer.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Value>
std::vector<Value> binary(const fs::path& path) {
  const std::string bytes = content(path);
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
  return values;
}

std::vector<nlohmann::json> json_lines(const fs::path& path) {
  std::istringstream lines(content(path));
  std::vector<nlohmann::json> result;
  for (std::string line; std::getline(lines, line);) {
    result.push_back(nlohmann::json::parse(line));
  }
  return result;
}

class SequenceFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dynamic_icp_sequence_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const fs::path& to) const {
    SequenceWriter writer(to);
    for (std::size_t i = 0; i < simulation_.size(); ++i) {
      writer.add(simulation_.frame(i, workers_));
    }
    writer.finish(simulation_, "1.2.3");
  }

  static SimulationConfig config() {
    SimulationConfig config = default_config(find_scene("street"));
    config.frames = 4;
    config.lidar.columns = 300;
    config.lidar.rows = 32;
    return config;
  }

  fs::path folder_;
  const Simulation simulation_{find_scene("street"), config()};
  const Workers workers_{2};
};

TEST_F(SequenceFiles, PointsAndLabelsComeBack) {
  write(folder_);
  for (std::size_t i = 0; i < 4; ++i) {
    const SimulatedFrame frame = simulation_.frame(i, workers_);
    const std::string name = "0000" + std::to_string(i + 1) + ".bin";
    const auto values = binary<float>(folder_ / "point_clouds" / name);
    const auto labels = binary<std::int32_t>(folder_ / "labels" / name);
    ASSERT_EQ(values.size(), 4 * frame.scan.bodies.size());
    ASSERT_EQ(labels, frame.scan.bodies);
    for (std::size_t k = 0; k < labels.size(); ++k) {
      const Eigen::Vector3d p(values[4 * k], values[4 * k + 1], values[4 * k + 2]);
      ASSERT_LT((p - frame.scan.measured.points[k]).norm(), 3e-5);
      ASSERT_NEAR(values[4 * k + 3], frame.scan.measured.doppler[k], 1e-5);
    }
  }
}

TEST_F(SequenceFiles, PosesAreRelativeToTheFirstScan) {
  write(folder_);
  std::istringstream rows(content(folder_ / "ref_poses.txt"));
  const Eigen::Isometry3d T_first_world = simulation_.frame(0, workers_).T_world_sensor.inverse();
  for (std::size_t i = 0; i < 4; ++i) {
    std::string stamp;
    double x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
    rows >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw;
    EXPECT_EQ(stamp, "0." + std::to_string(i) + "00000000");
    const Eigen::Isometry3d T = Eigen::Translation3d(x, y, z) * Eigen::Quaterniond(qw, qx, qy, qz);
    const Eigen::Isometry3d expected = T_first_world * simulation_.frame(i, workers_).T_world_sensor;
    EXPECT_LT((T.matrix() - expected.matrix()).norm(), 5e-9);
    if (i == 0) {
      EXPECT_EQ(T.matrix(), Eigen::Matrix4d::Identity());
    }
  }
}

TEST_F(SequenceFiles, TruthIsComplete) {
  write(folder_);
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
    EXPECT_EQ(ego[i]["velocity_sensor"][2], frame.velocity_sensor.z());
    EXPECT_EQ(ego[i]["angular_velocity_sensor"][0], frame.angular_velocity_sensor.x());
  }
  const auto summary = nlohmann::json::parse(content(folder_ / "scene.json"));
  EXPECT_EQ(summary["scene"], "street");
  EXPECT_EQ(summary["version"], "1.2.3");
  EXPECT_EQ(summary["settings"]["lidar.columns"], 300);
  EXPECT_EQ(summary["frames"], 4);
}

TEST_F(SequenceFiles, SameBytesEachTime) {
  fs::create_directories(folder_ / "a");
  fs::create_directories(folder_ / "b");
  write(folder_ / "a");
  write(folder_ / "b");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "a")) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(content(entry.path()), content(folder_ / "b" / fs::relative(entry.path(), folder_ / "a")));
      ++files;
    }
  }
  EXPECT_EQ(files, 4U + 4U + 4U);
}

TEST_F(SequenceFiles, AStandingBodysPointsAreLabelledStatic) {
  SimulatedFrame frame;
  frame.T_world_sensor.setIdentity();
  frame.velocity_sensor.setZero();
  frame.angular_velocity_sensor.setZero();
  frame.scan.measured.points = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  frame.scan.measured.doppler = {0.0, 0.0};
  frame.scan.bodies = {3, 4};
  ObjectTruth moving;
  moving.id = 4;
  moving.T_sensor_body.setIdentity();
  moving.center_sensor = moving.size = moving.velocity_sensor = Eigen::Vector3d::Ones();
  frame.objects = {moving};
  SequenceWriter writer(folder_);
  writer.add(frame);
  EXPECT_EQ(binary<std::int32_t>(folder_ / "labels" / "00001.bin"), (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(writer.counts().moving_points, 1U);
}

TEST_F(SequenceFiles, FailuresNameFileAndReason) {
  const auto expect_fault = [](const auto& action, const std::string& file) {
    try {
      action();
      FAIL() << file;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("cannot"), std::string::npos) << error.what();
    }
  };
  expect_fault([&] { SequenceWriter writer(folder_ / "missing"); }, "ref_poses.txt: cannot create: No such file");
  std::ofstream(folder_ / "labels") << "a file where a folder must be";
  expect_fault([&] { SequenceWriter writer(folder_); }, "labels");
  fs::remove(folder_ / "labels");
  expect_fault(
      [&] {
        SequenceWriter writer(folder_);
        fs::remove_all(folder_ / "point_clouds");
        writer.add(simulation_.frame(0, workers_));
      },
      "00001.bin");
  // A full disk.
  if (fs::exists("/dev/full")) {
    fs::remove_all(folder_ / "point_clouds");
    fs::remove(folder_ / "ego.jsonl");
    fs::create_symlink("/dev/full", folder_ / "ego.jsonl");
    expect_fault([&] { write(folder_); }, "ego.jsonl: cannot write: No space left");
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
