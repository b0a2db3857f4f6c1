// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/sequence_writer.hpp"

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/base/stamp.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

[[noreturn]] void throw_fault(const fs::path& path, const char* action) {
  throw DataError(fmt::format("{}: cannot {}: {}", path.string(), action, std::strerror(errno)));
}

template <class Value>
void write_binary(const fs::path& path, const std::vector<Value>& values) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!file) {
    throw_fault(path, "create");
  }
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(Value)));
  file.close();
  if (!file) {
    throw_fault(path, "write");
  }
}

void make_folder(const fs::path& path) {
  std::error_code fault;
  fs::create_directories(path, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot create: {}", path.string(), fault.message()));
  }
}

Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::vector<float> columns_of(const RawScan& scan) {
  std::vector<float> values;
  values.reserve(4 * scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    for (const double value : {scan.points[i].x(), scan.points[i].y(), scan.points[i].z(), scan.doppler[i]}) {
      values.push_back(static_cast<float>(value));
    }
  }
  return values;
}

/// Ids of bodies that stand now become 0.
std::vector<std::int32_t> labels_of(const SimulatedFrame& frame) {
  std::vector<std::int32_t> labels = frame.scan.bodies;
  for (std::int32_t& label : labels) {
    const bool moving = std::any_of(frame.objects.begin(), frame.objects.end(),
                                    [&](const ObjectTruth& object) { return object.id == label; });
    label = moving ? label : 0;
  }
  return labels;
}

Json settings(SimulationConfig config) {
  Json json = Json::object();
  for (const ConfigField& field : fields(config)) {
    std::visit([&](const auto* value) { json[field.key] = *value; }, field.value);
  }
  return json;
}

Json object_json(const ObjectTruth& object) {
  const Eigen::Quaterniond q(object.T_sensor_body.linear());
  return {{"id", object.id},
          {"kind", object.name},
          {"velocity_sensor", to_json(object.velocity_sensor)},
          {"center_sensor", to_json(object.center_sensor)},
          {"size", to_json(object.size)},
          {"orientation_sensor_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"yaw_rate", object.yaw_rate_rps},
          {"points", object.points}};
}

/// {"index": ..., "timestamp": ..., with the exact time stamp, which a double could not hold.
std::string line_start(const SimulatedFrame& frame) {
  return fmt::format("{{\"index\":{},\"timestamp\":{}", frame.index, format_seconds(frame.scan.measured.stamp));
}

}  // namespace

SequenceWriter::SequenceWriter(const fs::path& folder)
    : folder_(folder),
      poses_(open(folder / "ref_poses.txt")),
      objects_(open(folder / "objects.jsonl")),
      ego_(open(folder / "ego.jsonl")) {
  make_folder(folder_ / "point_clouds");
  make_folder(folder_ / "labels");
}

void SequenceWriter::add(const SimulatedFrame& frame) {
  const std::string name = fmt::format("{:05}.bin", frame.index + 1);
  const std::vector<std::int32_t> labels = labels_of(frame);
  write_binary(folder_ / "point_clouds" / name, columns_of(frame.scan.measured));
  write_binary(folder_ / "labels" / name, labels);
  add_pose(frame);
  add_objects(frame);
  add_ego(frame);
  ++counts_.scans;
  counts_.points += labels.size();
  counts_.objects += frame.objects.size();
  for (const std::int32_t label : labels) {
    counts_.moving_points += label > 0 ? 1 : 0;
  }
}

void SequenceWriter::add_pose(const SimulatedFrame& frame) {
  if (counts_.scans == 0) {
    T_first_world_ = frame.T_world_sensor.inverse();
  } else {
    counts_.path_length_m += (frame.T_world_sensor.translation() - last_position_).norm();
  }
  last_position_ = frame.T_world_sensor.translation();
  Eigen::Isometry3d T = T_first_world_ * frame.T_world_sensor;
  if (counts_.scans == 0) {
    T.setIdentity();  // not even rounding errors in the first pose
  }
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  write(poses_,
        fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n",
                    format_seconds(frame.scan.measured.stamp), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()));
}

void SequenceWriter::add_objects(const SimulatedFrame& frame) {
  Json objects = Json::array();
  for (const ObjectTruth& object : frame.objects) {
    objects.push_back(object_json(object));
  }
  write(objects_, fmt::format("{},\"objects\":{}}}\n", line_start(frame), objects.dump()));
}

void SequenceWriter::add_ego(const SimulatedFrame& frame) {
  write(ego_, fmt::format("{},\"velocity_sensor\":{},\"angular_velocity_sensor\":{}}}\n", line_start(frame),
                          to_json(frame.velocity_sensor).dump(), to_json(frame.angular_velocity_sensor).dump()));
}

void SequenceWriter::finish(const Simulation& simulation, std::string_view version) {
  close(poses_);
  close(objects_);
  close(ego_);
  const World& world = simulation.scene().world;
  const Json json = {{"scene", simulation.kind().name},
                     {"description", simulation.kind().description},
                     {"version", version},
                     {"settings", settings(simulation.config())},
                     {"frames", counts_.scans},
                     {"points", counts_.points},
                     {"moving_points", counts_.moving_points},
                     {"path_length_m", counts_.path_length_m},
                     {"static_triangles", world.statics.triangles.size()},
                     {"moving_bodies", world.bodies.size()}};
  LineFile file = open(folder_ / "scene.json");
  write(file, json.dump(2) + "\n");
  close(file);
}

SequenceWriter::LineFile SequenceWriter::open(const fs::path& path) {
  errno = 0;
  LineFile file{path, std::ofstream(path, std::ios::binary)};
  if (!file.stream) {
    throw_fault(path, "create");
  }
  return file;
}

void SequenceWriter::write(LineFile& file, std::string_view line) {
  errno = 0;
  file.stream << line;
  if (!file.stream) {
    throw_fault(file.path, "write");
  }
}

void SequenceWriter::close(LineFile& file) {
  errno = 0;
  file.stream.close();
  if (!file.stream) {
    throw_fault(file.path, "write");
  }
}

}  // namespace dynamic_icp::simulation
