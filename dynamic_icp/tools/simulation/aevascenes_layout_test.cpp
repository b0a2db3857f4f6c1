// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "dynamic_icp/tools/simulation/point_layout.hpp"

#include "testing/npz_by_hand.hpp"
#include "testing/written_files.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Two sensors without errors of measurement on one vehicle, one of them turned.
SimulationConfig two_sensors(const char* scene = "street") {
  SimulationConfig config = default_config(scenes::find_scene(scene));
  config.frames = 3;
  SensorConfig& front = config.rig.sensors.front();
  front.name = "front_wide_lidar";
  front.lidar = without_noise(front.lidar);
  front.lidar.columns = 120;
  front.lidar.rows = 16;
  SensorConfig left = front;
  left.name = "left_lidar";
  left.mount = {0.7, 0.5, 1.9, 2.0, -3.0, 80.0};
  config.rig.sensors = {front, left};
  return config;
}

Eigen::Vector3d vector_in(const json& value) {
  return {value["x"].get<double>(), value["y"].get<double>(), value["z"].get<double>()};
}

Eigen::Isometry3d pose_in(const json& value) {
  const json& q = value["rotation"];
  return Eigen::Translation3d(vector_in(value["translation"])) *
         Eigen::Quaterniond(q["w"].get<double>(), q["x"].get<double>(), q["y"].get<double>(), q["z"].get<double>());
}

/// The columns of one cloud.
struct Cloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<float> velocity;
  std::vector<float> reflectivity;
  std::vector<std::uint32_t> line_index;
  std::vector<std::uint32_t> time_offset_ns;
  std::vector<std::int64_t> classes;
};

Cloud cloud_in(const fs::path& path) {
  std::map<std::string, std::string> members;
  for (const auto& [name, bytes] : formats::stored_members(content(path))) {
    members[name] = bytes;
  }
  EXPECT_EQ(members.size(), 6U);
  Cloud cloud;
  const auto xyz = formats::numbers_of<float>(members.at("xyz.npy"), "'descr': '<f4', 'fortran_order': False");
  const std::string rows = std::to_string(xyz.size() / 3);
  EXPECT_NE(members["xyz.npy"].find("'shape': (" + rows + ", 3)"), std::string::npos);
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    cloud.points.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  }
  const auto header = [&](const std::string& type) {
    return "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + rows + ", 1), }";
  };
  cloud.velocity = formats::numbers_of<float>(members.at("velocity.npy"), header("<f4"));
  cloud.reflectivity = formats::numbers_of<float>(members.at("reflectivity.npy"), header("<f4"));
  cloud.line_index = formats::numbers_of<std::uint32_t>(members.at("line_index.npy"), header("<u4"));
  cloud.time_offset_ns = formats::numbers_of<std::uint32_t>(members.at("time_offset_ns.npy"), header("<u4"));
  cloud.classes = formats::numbers_of<std::int64_t>(members.at("semantic_labels_idx.npy"), header("<i8"));
  return cloud;
}

class AevaScenesLayoutFiles : public WrittenFiles {
 protected:
  void write(const fs::path& folder, const Simulation& simulation) const {
    const auto layout = make_aevascenes_layout(folder, simulation);
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      for (std::size_t sensor = 0; sensor < simulation.config().rig.sensors.size(); ++sensor) {
        layout->add(simulation.frame(i, workers_, sensor), sensor);
      }
    }
    layout->finish();
  }

  json sequence_of(const Simulation& simulation) const {
    write(folder_, simulation);
    return json::parse(content(folder_ / "sequence.json"));
  }

  [[nodiscard]] std::size_t files_in(const fs::path& folder) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_ / folder), fs::directory_iterator()));
  }
};

TEST_F(AevaScenesLayoutFiles, CloudsHoldTheScans) {
  const Simulation simulation(scenes::find_scene("street"), two_sensors());
  const json sequence = sequence_of(simulation);
  EXPECT_EQ(files_in("pointcloud_raw"), 6U);
  EXPECT_EQ(files_in("pointcloud_compensated"), 6U);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    for (std::size_t sensor = 0; sensor < 2; ++sensor) {
      const SimulatedScan scan = simulation.frame(i, workers_, sensor).scan;
      const std::string name = simulation.config().rig.sensors[sensor].name;
      const json& paths = sequence["frames"][i]["point_cloud"][name];
      EXPECT_EQ(paths["point_cloud_raw_path"],
                "pointcloud_raw/" + name + "_1735689600" + std::to_string(i) + "00000000.npz");
      const Cloud raw = cloud_in(folder_ / paths["point_cloud_raw_path"].get<std::string>());
      const Cloud compensated = cloud_in(folder_ / paths["point_cloud_compensated_path"].get<std::string>());
      EXPECT_EQ(raw.points, compensated.points);
      ASSERT_EQ(raw.points.size(), scan.bodies.size());
      for (std::size_t k = 0; k < raw.points.size(); ++k) {
        ASSERT_LT((raw.points[k] - scan.measured.points[k]).norm(), 3e-5);
        ASSERT_NEAR(raw.velocity[k], scan.measured.doppler[k], 1e-5);
        ASSERT_NEAR(raw.reflectivity[k], std::min(8191.0F, 8191.0F * scan.reflectivity[k]), 0.51F);
        ASSERT_EQ(raw.line_index[k], scan.lines[k]);
        ASSERT_NEAR(raw.time_offset_ns[k], 1e9 * scan.measured.times[k], 0.5 + 1e-6);
      }
    }
  }
}

TEST_F(AevaScenesLayoutFiles, CompensatedDopplerIsThatOfASensorAtRest) {
  const Simulation simulation(scenes::find_scene("street"), two_sensors());
  const json sequence = sequence_of(simulation);
  std::size_t static_frame = 0;
  std::size_t moving = 0;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    for (std::size_t sensor = 0; sensor < 2; ++sensor) {
      const SimulatedScan scan = simulation.frame(i, workers_, sensor).scan;
      const std::string name = simulation.config().rig.sensors[sensor].name;
      const std::string path = sequence["frames"][i]["point_cloud"][name]["point_cloud_compensated_path"];
      const Cloud cloud = cloud_in(folder_ / path);
      ASSERT_EQ(cloud.velocity.size(), scan.bodies.size());
      for (std::size_t k = 0; k < scan.bodies.size(); ++k) {
        if (scan.bodies[k] == 0) {
          ASSERT_NEAR(cloud.velocity[k], 0.0, 2e-6);
          ASSERT_EQ(cloud.classes[k], 0);
          ++static_frame;
        } else {
          moving += std::abs(cloud.velocity[k]) > 0.5 ? 1 : 0;
          ASSERT_NE(cloud.classes[k], 0);
        }
      }
    }
  }
  EXPECT_GT(static_frame, 1000U);
  EXPECT_GT(moving, 20U);
}

TEST_F(AevaScenesLayoutFiles, PosesAndMountingsAreThoseOfTheVehicle) {
  const Simulation simulation(scenes::find_scene("street"), two_sensors());
  const json sequence = sequence_of(simulation);
  const json& metadata = sequence["metadata"];
  EXPECT_EQ(metadata["sensors"]["lidars"], json({"front_wide_lidar", "left_lidar"}));
  EXPECT_EQ(metadata["sensors"]["cameras"], json::array());
  for (const char* key : {"camera_lidar_mapping", "vehicle_to_camera_extrinsics", "camera_intrinsics"}) {
    EXPECT_EQ(metadata[key], json::object()) << key;
  }
  ASSERT_EQ(sequence["frames"].size(), 3U);
  EXPECT_EQ(pose_in(sequence["frames"][0]["ego_pose"]).matrix(), Eigen::Matrix4d::Identity());
  std::set<std::string> identifiers = {metadata["sequence_uuid"]};
  for (std::size_t i = 0; i < 3; ++i) {
    const json& frame = sequence["frames"][i];
    EXPECT_EQ(frame["timestamp_ns"], 1'735'689'600'000'000'000 + static_cast<std::int64_t>(i) * 100'000'000);
    EXPECT_EQ(frame["frame_idx"], i);
    EXPECT_EQ(frame["image"], json::object());
    identifiers.insert(frame["frame_uuid"].get<std::string>());
    // World to vehicle to sensor must be where the simulation has the sensor, from the first frame on.
    for (std::size_t sensor = 0; sensor < 2; ++sensor) {
      const json& extrinsics = metadata["vehicle_to_lidar_extrinsics"][metadata["sensors"]["lidars"][sensor]];
      const auto T_world_sensor = [&](std::size_t index) {
        return simulation.frame(index, workers_, sensor).sensor.T_world_sensor;
      };
      const Eigen::Isometry3d T_first_sensor = pose_in(frame["ego_pose"]) * pose_in(extrinsics);
      const Eigen::Isometry3d expected = pose_in(extrinsics) * T_world_sensor(0).inverse() * T_world_sensor(i);
      EXPECT_LT((T_first_sensor.matrix() - expected.matrix()).norm(), 1e-9);
    }
  }
  EXPECT_EQ(identifiers.size(), 4U);
  for (const std::string& identifier : identifiers) {
    EXPECT_EQ(identifier.size(), 36U);
    EXPECT_EQ(identifier[8] == '-' && identifier[13] == '-' && identifier[18] == '-' && identifier[23] == '-', true);
  }
}

/// Checks that the points of a moving body that lie in `box` have its class and the Doppler of its motion. Returns
/// their number.
std::size_t check_points_in(const json& box, const Cloud& cloud, const Eigen::Isometry3d& T_vehicle_lidar) {
  const Eigen::Isometry3d T_box_vehicle = pose_in(box["pose"]).inverse();
  const Eigen::Vector3d half = 0.5 * vector_in(box["dimensions"]) + Eigen::Vector3d::Constant(1e-4);
  std::size_t points = 0;
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const Eigen::Vector3d p_vehicle = T_vehicle_lidar * cloud.points[k];
    if (cloud.classes[k] == 0 || ((T_box_vehicle * p_vehicle).cwiseAbs().array() > half.array()).any()) {
      continue;
    }
    EXPECT_EQ(cloud.classes[k], box["class_idx"]) << box["class"];
    const Eigen::Vector3d arm = p_vehicle - vector_in(box["pose"]["translation"]);
    const Eigen::Vector3d velocity = vector_in(box["linear_velocity"]) + vector_in(box["angular_velocity"]).cross(arm);
    const Eigen::Vector3d u = T_vehicle_lidar.linear() * cloud.points[k].normalized();
    EXPECT_NEAR(cloud.velocity[k], u.dot(velocity), 1e-5);
    ++points;
  }
  return points;
}

TEST_F(AevaScenesLayoutFiles, BoxesHoldTheirPointsAndExplainTheirDoppler) {
  // Bodies and vehicle turn. All rays are of the time of the stamp, as the boxes are.
  SimulationConfig config = two_sensors("roundabout");
  for (SensorConfig& sensor : config.rig.sensors) {
    sensor.lidar = instant(sensor.lidar);
  }
  const Simulation simulation(scenes::find_scene("roundabout"), config);
  const json sequence = sequence_of(simulation);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const json& frame = sequence["frames"][i];
    std::size_t found = 0;
    for (const auto& [name, paths] : frame["point_cloud"].items()) {
      const Cloud cloud = cloud_in(folder_ / paths["point_cloud_compensated_path"].get<std::string>());
      for (const json& box : frame["boxes"]) {
        found += check_points_in(box, cloud, pose_in(sequence["metadata"]["vehicle_to_lidar_extrinsics"][name]));
      }
    }
    std::size_t expected = 0;
    for (std::size_t sensor = 0; sensor < 2; ++sensor) {
      for (const ObjectTruth& object : simulation.frame(i, workers_, sensor).objects) {
        expected += object.points;
      }
    }
    EXPECT_GT(expected, 10U);
    EXPECT_EQ(found, expected) << "each point of a moving body lies in one box";
  }
}

TEST_F(AevaScenesLayoutFiles, ListsABodyThatTwoSensorsSeeOnce) {
  SimulationConfig config = two_sensors();
  config.rig.sensors[1].mount = config.rig.sensors[0].mount;
  const Simulation simulation(scenes::find_scene("street"), config);
  const json sequence = sequence_of(simulation);
  std::map<std::string, json> dimensions;
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const json& boxes = sequence["frames"][i]["boxes"];
    ASSERT_FALSE(boxes.empty());
    EXPECT_EQ(boxes.size(), simulation.frame(i, workers_).objects.size());
    for (const json& box : boxes) {
      EXPECT_EQ(box["reference_frame"], "VEHICLE");
      const auto [known, is_new] = dimensions.try_emplace(box["id"].get<std::string>(), box["dimensions"]);
      EXPECT_EQ(known->second, box["dimensions"]) << "the same track in all frames";
    }
  }
}

TEST_F(AevaScenesLayoutFiles, SensorsThatStartLaterShareTheTimeOfTheFrame) {
  SimulationConfig config = two_sensors();
  config.rig.sensors[0].mount.yaw_deg = 180.0;  // sees nothing of what is ahead
  config.rig.sensors[1].mount = {1.5, 0.2, 1.9, 0.0, 0.0, 0.0};
  for (SensorConfig& sensor : config.rig.sensors) {
    sensor.lidar = instant(sensor.lidar);
  }
  config.rig.sensors[1].lidar.timing.start_s = 0.04;
  const Simulation simulation(scenes::find_scene("street"), config);
  const json sequence = sequence_of(simulation);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const json& frame = sequence["frames"][i];
    EXPECT_EQ(frame["timestamp_ns"], 1'735'689'600'000'000'000 + static_cast<std::int64_t>(i) * 100'000'000);
    const auto offset = [&](const char* name) {
      const json& path = frame["point_cloud"][name]["point_cloud_raw_path"];
      return cloud_in(folder_ / path.get<std::string>()).time_offset_ns.front();
    };
    EXPECT_EQ(offset("front_wide_lidar"), 0U);
    EXPECT_EQ(offset("left_lidar"), 40'000'000U);
    // Boxes are where the bodies are when the frame begins, whoever saw them.
    const double time_s = 0.1 * static_cast<double>(i);
    const Eigen::Isometry3d T_vehicle_world = simulation.scene().vehicle(time_s).T_world_body.inverse();
    ASSERT_FALSE(frame["boxes"].empty());
    for (const json& box : frame["boxes"]) {
      double nearest = 1e9;
      for (const world::MovingBody& body : simulation.scene().world.bodies) {
        const Eigen::Vector3d center = simulation.scene().world.shapes[body.shape].box.center();
        const Eigen::Vector3d expected = T_vehicle_world * body.trajectory(time_s).T_world_body * center;
        nearest = std::min(nearest, (expected - vector_in(box["pose"]["translation"])).norm());
      }
      EXPECT_LT(nearest, 1e-9);
    }
  }
}

TEST_F(AevaScenesLayoutFiles, ClassesAreThoseOfTheDataSet) {
  const std::map<std::string, std::int64_t> documented = {
      {"unknown", 0}, {"car", 1}, {"truck", 3}, {"other_vehicle", 6}, {"pedestrian", 9}};
  const std::map<std::string, std::string> named = {
      {"car", "car"}, {"truck", "truck"}, {"van", "other_vehicle"}, {"pedestrian", "pedestrian"}, {"ufo", "unknown"}};
  SimulatedFrame frame = simulation_.frame(0, workers_);
  ASSERT_FALSE(frame.objects.empty());
  frame.objects.resize(1);
  const auto layout = make_aevascenes_layout(folder_, simulation_);
  for (const auto& [body, name] : named) {
    frame.objects.front().name = body;
    layout->add(frame, 0);
    ++frame.index;
  }
  layout->finish();
  const json frames = json::parse(content(folder_ / "sequence.json"))["frames"];
  ASSERT_EQ(frames.size(), named.size());
  auto expected = named.begin();
  for (const json& written : frames) {
    EXPECT_EQ(written["boxes"][0]["class"], expected->second);
    EXPECT_EQ(written["boxes"][0]["class_idx"], documented.at(expected->second));
    ++expected;
  }
}

TEST_F(AevaScenesLayoutFiles, SameBytesEachTime) {
  const Simulation simulation(scenes::find_scene("street"), two_sensors());
  for (const char* name : {"a", "b"}) {
    fs::create_directories(folder_ / name);
    write(folder_ / name, simulation);
  }
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "a")) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(content(entry.path()), content(folder_ / "b" / fs::relative(entry.path(), folder_ / "a")));
      ++files;
    }
  }
  EXPECT_EQ(files, 13U);
}

}  // namespace
}  // namespace dynamic_icp::simulation
