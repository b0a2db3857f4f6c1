// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/simulation/compensated_doppler.hpp"
#include "dynamic_icp/tools/simulation/named_source.hpp"
#include "dynamic_icp/tools/simulation/point_layout.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kRawFolder = "pointcloud_raw";
constexpr const char* kCompensatedFolder = "pointcloud_compensated";
constexpr double kLargestReflectivity = 8191.0;

/// A class of the data set and what the scenes call its bodies.
struct ObjectClass {
  std::string_view body;
  std::string_view name;
  std::int64_t index;
};

constexpr ObjectClass kUnknown = {"", "unknown", 0};
constexpr std::array<ObjectClass, 8> kClasses = {{{"car", "car", 1},
                                                  {"bus", "bus", 2},
                                                  {"truck", "truck", 3},
                                                  {"trailer", "trailer", 4},
                                                  {"van", "other_vehicle", 6},
                                                  {"bicycle", "bicycle", 7},
                                                  {"pedestrian", "pedestrian", 9},
                                                  {"bicyclist", "bicyclist", 12}}};

const ObjectClass& class_of(std::string_view body) {
  const auto* const found =
      std::find_if(kClasses.begin(), kClasses.end(), [&](const ObjectClass& known) { return known.body == body; });
  return found == kClasses.end() ? kUnknown : *found;
}

Json xyz_json(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

Json to_json(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  return {{"translation", xyz_json(Eigen::Vector3d(T.translation()))},
          {"rotation", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}}};
}

/// An identifier as text, always the same for the same source.
std::string uuid(const RandomSource& source) {
  const std::uint64_t high = source.bits(0);
  const std::uint64_t low = source.bits(1);
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, high >> 16U & 0xFFFFU, high & 0xFFFFU,
                     low >> 48U, low & 0xFFFFFFFFFFFFU);
}

/// The source of a sequence's identifiers.
RandomSource identifiers_of(const Simulation& simulation) {
  return named_source(RandomSource(static_cast<std::uint64_t>(simulation.config().scene.seed)), simulation.kind().name);
}

template <class Number, class Value>
formats::NpzMember column(const char* name, std::size_t rows, const Value& value) {
  std::vector<Number> numbers(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    numbers[i] = static_cast<Number>(value(i));
  }
  return {name, formats::npy_array<Number>({rows, 1}, numbers)};
}

formats::NpzMember points_of(const RawScan& scan) {
  std::vector<float> numbers;
  numbers.reserve(3 * scan.points.size());
  for (const Eigen::Vector3d& point : scan.points) {
    const Eigen::Vector3f p = point.cast<float>();
    numbers.insert(numbers.end(), p.begin(), p.end());
  }
  return {"xyz", formats::npy_array<float>({scan.points.size(), 3}, numbers)};
}

class AevaScenesLayout : public PointLayout {
 public:
  AevaScenesLayout(const fs::path& folder, const Simulation& simulation)
      : folder_(folder), simulation_(simulation), identifiers_(identifiers_of(simulation)) {
    formats::make_folder(folder_ / kRawFolder);
    formats::make_folder(folder_ / kCompensatedFolder);
    for (const world::MovingBody& body : simulation.scene().world.bodies) {
      bodies_[body.id] = &body;
    }
  }

  void add(const SimulatedFrame& frame, std::size_t sensor) override {
    if (frames_.empty() || frames_.back()["frame_idx"] != frame.index) {
      begin_frame(frame);
    }
    const std::string name = fmt::format("{}_{}.npz", sensor_config(sensor).name, unix_stamp_ns(frame));
    write_points(frame, sensor, name);
    frames_.back()["point_cloud"][sensor_config(sensor).name] = {
        {"point_cloud_compensated_path", fmt::format("{}/{}", kCompensatedFolder, name)},
        {"point_cloud_raw_path", fmt::format("{}/{}", kRawFolder, name)}};
    add_boxes(frame, sensor);
  }

  void finish() override {
    const Json sequence = {{"metadata", metadata()}, {"frames", frames_}};
    formats::write_whole_file(folder_ / "sequence.json", sequence.dump(2) + "\n");
  }

 private:
  [[nodiscard]] const SensorConfig& sensor_config(std::size_t sensor) const {
    return simulation_.config().rig.sensors.at(sensor);
  }

  static std::int64_t unix_stamp_ns(const SimulatedFrame& frame) {
    return frame.scan.measured.stamp.ns + kUnixTimeOfStart;
  }

  /// When the last frame began, on the clock of the drive.
  [[nodiscard]] double frame_time_s() const { return seconds_between(Stamp{}, frame_time_.begin); }

  [[nodiscard]] Eigen::Isometry3d T_world_vehicle() const {
    return simulation_.scene().vehicle(frame_time_s()).T_world_body;
  }

  /// A frame begins with the first of its scans, as their stamps say.
  void begin_frame(const SimulatedFrame& frame) {
    frame_time_ = {frame.begin, frame.scan.measured.stamp};
    for (std::size_t sensor = 0; sensor < simulation_.config().rig.sensors.size(); ++sensor) {
      const ScanTime time = simulation_.scan_time(frame.index, sensor);
      frame_time_ = !time.missing && time.stamp < frame_time_.stamp ? time : frame_time_;
    }
    Eigen::Isometry3d T_first_vehicle = Eigen::Isometry3d::Identity();
    if (frames_.empty()) {
      T_first_world_ = T_world_vehicle().inverse();
    } else {
      T_first_vehicle = T_first_world_ * T_world_vehicle();
    }
    frames_.push_back({{"timestamp_ns", frame_time_.stamp.ns + kUnixTimeOfStart},
                       {"frame_idx", frame.index},
                       {"frame_uuid", uuid(identifiers_.fork(0).fork(frame.index))},
                       {"ego_pose", to_json(T_first_vehicle)},
                       {"point_cloud", Json::object()},
                       {"image", Json::object()},
                       {"boxes", Json::array()}});
  }

  void write_points(const SimulatedFrame& frame, std::size_t sensor, const std::string& name) const {
    const SimulatedScan& scan = frame.scan;
    const std::size_t rows = scan.measured.points.size();
    const auto doppler = [](const std::vector<double>& values) {
      return column<float>("velocity", values.size(), [&](std::size_t i) { return values[i]; });
    };
    std::vector<formats::NpzMember> members = {
        points_of(scan.measured),
        doppler(scan.measured.doppler),
        column<float>("reflectivity", rows,
                      [&](std::size_t i) {
                        return std::min(kLargestReflectivity, std::round(kLargestReflectivity * scan.reflectivity[i]));
                      }),
        column<std::uint32_t>("line_index", rows, [&](std::size_t i) { return scan.lines[i]; }),
        column<std::uint32_t>("time_offset_ns", rows,
                              [&](std::size_t i) { return offset_ns(scan.measured, scan.measured.times[i]); }),
        column<std::int64_t>("semantic_labels_idx", rows, [&](std::size_t i) { return class_index(scan.bodies[i]); })};
    write_archive(folder_ / kRawFolder / name, members);
    members[1] = doppler(compensated_doppler(scan.measured, simulation_, sensor));
    write_archive(folder_ / kCompensatedFolder / name, members);
  }

  /// Time of a point after the stamp of the frame.
  [[nodiscard]] std::int64_t offset_ns(const RawScan& scan, double time_s) const {
    const std::int64_t ns = scan.stamp.ns - frame_time_.stamp.ns + std::llround(kNanoseconds * time_s);
    if (ns < 0) {
      throw UsageError("layout aevascenes: lidar.timing.point_time_offset_s: points before their frame do not fit");
    }
    return ns;
  }

  static void write_archive(const fs::path& path, const std::vector<formats::NpzMember>& members) {
    const std::string bytes = formats::npz_bytes(members);
    formats::write_bytes(path, std::as_bytes(std::span(bytes)));
  }

  [[nodiscard]] std::int64_t class_index(std::int32_t body) const {
    const auto found = bodies_.find(body);
    return found == bodies_.end() ? kUnknown.index : class_of(found->second->name).index;
  }

  /// The bodies that no sensor before has shown in this frame.
  void add_boxes(const SimulatedFrame& frame, std::size_t sensor) {
    Json& boxes = frames_.back()["boxes"];
    for (const ObjectTruth& seen : frame.objects) {
      const std::string id = uuid(identifiers_.fork(1).fork(static_cast<std::uint64_t>(seen.id)));
      if (std::none_of(boxes.begin(), boxes.end(), [&](const Json& box) { return box["id"] == id; })) {
        const bool later = frame.begin != frame_time_.begin;
        boxes.push_back(box_json(later ? simulation_.object(seen.id, frame_time_s(), sensor) : seen, id, sensor));
      }
    }
  }

  [[nodiscard]] Json box_json(const ObjectTruth& object, const std::string& id, std::size_t sensor) const {
    const Eigen::Isometry3d T_vehicle_lidar = T_vehicle_sensor(sensor_config(sensor).mount);
    Eigen::Isometry3d T_vehicle_box = T_vehicle_lidar * object.T_sensor_body;
    T_vehicle_box.translation() = T_vehicle_lidar * object.center_sensor;
    const Eigen::Vector3d turning_vehicle = T_world_vehicle().linear().transpose() *
                                            bodies_.at(object.id)->trajectory(frame_time_s()).angular_velocity_world;
    const ObjectClass& object_class = class_of(object.name);
    return {{"id", id},
            {"reference_frame", "VEHICLE"},
            {"dimensions", xyz_json(object.size)},
            {"pose", to_json(T_vehicle_box)},
            {"linear_velocity", xyz_json(Eigen::Vector3d(T_vehicle_lidar.linear() * object.velocity_sensor))},
            {"angular_velocity", xyz_json(turning_vehicle)},
            {"class", object_class.name},
            {"class_idx", object_class.index}};
  }

  [[nodiscard]] Json metadata() const {
    Json names = Json::array();
    Json extrinsics = Json::object();
    for (const SensorConfig& sensor : simulation_.config().rig.sensors) {
      names.push_back(sensor.name);
      extrinsics[sensor.name] = to_json(T_vehicle_sensor(sensor.mount));
    }
    return {{"sequence_uuid", uuid(identifiers_)},
            {"sensors", {{"lidars", names}, {"cameras", Json::array()}}},
            {"camera_lidar_mapping", Json::object()},
            {"vehicle_to_lidar_extrinsics", extrinsics},
            {"vehicle_to_camera_extrinsics", Json::object()},
            {"camera_intrinsics", Json::object()}};
  }

  fs::path folder_;
  const Simulation& simulation_;
  RandomSource identifiers_;
  std::map<std::int32_t, const world::MovingBody*> bodies_;  ///< by their ids
  Eigen::Isometry3d T_first_world_ = Eigen::Isometry3d::Identity();
  ScanTime frame_time_;  ///< of the last frame
  std::vector<Json> frames_;
};

}  // namespace

std::unique_ptr<PointLayout> make_aevascenes_layout(const fs::path& folder, const Simulation& simulation) {
  return std::make_unique<AevaScenesLayout>(folder, simulation);
}

}  // namespace dynamic_icp::simulation
