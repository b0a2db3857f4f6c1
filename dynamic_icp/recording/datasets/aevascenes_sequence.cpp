// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/aevascenes_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

using Json = nlohmann::json;

constexpr double kQuaternionTolerance = 1e-3;

/// What is being read, for messages.
struct Place {
  const std::filesystem::path& path;
  std::string where;  ///< "frame 3"

  [[noreturn]] void fail(std::string_view message) const {
    throw DataError(fmt::format("{}: {}: {}", path.string(), where, message));
  }
};

Eigen::Vector3d vector_of(const Json& json) {
  return {json.at("x").get<double>(), json.at("y").get<double>(), json.at("z").get<double>()};
}

Eigen::Isometry3d pose_of(const Json& json, const Place& place) {
  const Json& q = json.at("rotation");
  const Eigen::Quaterniond rotation(q.at("w").get<double>(), q.at("x").get<double>(), q.at("y").get<double>(),
                                    q.at("z").get<double>());
  const Eigen::Vector3d translation = vector_of(json.at("translation"));
  if (!(std::abs(rotation.norm() - 1.0) <= kQuaternionTolerance) || !translation.allFinite()) {
    place.fail(
        fmt::format("a pose has a quaternion of length {:.6g} at ({}, {}, {}) m, expected length 1 and finite "
                    "numbers",
                    rotation.norm(), translation.x(), translation.y(), translation.z()));
  }
  return Eigen::Translation3d(translation) * rotation.normalized();
}

Stamp stamp_of(const Json& json, const Place& place) {
  const std::optional<std::int64_t> ns = json.is_string() ? parse_number<std::int64_t>(json.get<std::string>())
                                         : json.is_number_integer() ? std::optional(json.get<std::int64_t>())
                                                                    : std::nullopt;
  if (!ns) {
    place.fail(fmt::format("timestamp_ns is {}, expected whole nanoseconds", json.dump().substr(0, 40)));
  }
  return Stamp{*ns};
}

std::string text_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() || !found->is_string() ? "" : found->get<std::string>();
}

/// A path below the folder of the sequence; empty where there is none. One that leads elsewhere would read what the
/// user did not name.
std::string path_of(const Json& json, const char* key, const Place& place) {
  const std::string text = text_of(json, key);
  const std::filesystem::path path = std::filesystem::path(text).lexically_normal();
  if (path.is_absolute() || (!path.empty() && *path.begin() == "..")) {
    place.fail(fmt::format("{} is {}, expected a path that stays within the folder of the sequence", key,
                           formats::quoted_text(text)));
  }
  return text;
}

/// Boxes are in vehicle axes, but for those that say they are in a LiDAR's.
AevaScenesBox box_of(const Json& json, const AevaScenesSequence& sequence, const Place& place) {
  AevaScenesBox box;
  box.id = text_of(json, "id");
  box.class_name = text_of(json, "class");
  box.dimensions = vector_of(json.at("dimensions"));
  box.T_vehicle_box = pose_of(json.at("pose"), place);
  if (json.contains("linear_velocity") && json["linear_velocity"].is_object()) {
    box.velocity_vehicle = vector_of(json["linear_velocity"]);
  }
  const auto frame = sequence.T_vehicle_lidar.find(text_of(json, "reference_frame"));
  if (frame != sequence.T_vehicle_lidar.end()) {
    box.T_vehicle_box = frame->second * box.T_vehicle_box;
    box.velocity_vehicle = frame->second.linear() * box.velocity_vehicle;
  }
  return box;
}

AevaScenesFrame frame_of(const Json& json, const AevaScenesSequence& sequence, const Place& place) {
  AevaScenesFrame frame;
  frame.stamp = stamp_of(json.at("timestamp_ns"), place);
  if (json.contains("ego_pose") && !json["ego_pose"].is_null()) {
    frame.T_world_vehicle = pose_of(json["ego_pose"], place);
  }
  for (const auto& [lidar, cloud] : json.at("point_cloud").items()) {
    AevaScenesPaths paths{path_of(cloud, "point_cloud_compensated_path", place),
                          path_of(cloud, "point_cloud_raw_path", place)};
    // v0.x has one path only; the folder it is in says which Doppler.
    const std::string only = path_of(cloud, "point_cloud_path", place);
    (only.find("raw") == std::string::npos ? paths.compensated : paths.raw).append(only);
    if (!paths.compensated.empty() || !paths.raw.empty()) {
      frame.clouds[lidar] = paths;
    }
  }
  if (json.contains("boxes") && json["boxes"].is_array()) {
    for (const Json& box : json["boxes"]) {
      frame.boxes.push_back(box_of(box, sequence, place));
    }
  }
  return frame;
}

void read_metadata(const Json& metadata, AevaScenesSequence& sequence, Place& place) {
  for (const auto& [lidar, extrinsic] : metadata.at("vehicle_to_lidar_extrinsics").items()) {
    place.where = fmt::format("extrinsics of {}", lidar);
    sequence.T_vehicle_lidar[lidar] = pose_of(extrinsic, place);
  }
  place.where = "metadata";
  if (metadata.contains("sensors")) {
    for (const Json& lidar : metadata["sensors"].at("lidars")) {
      sequence.lidars.push_back(lidar.get<std::string>());
    }
  } else {
    for (const auto& [lidar, pose] : sequence.T_vehicle_lidar) {
      sequence.lidars.push_back(lidar);
    }
  }
  std::erase_if(sequence.lidars, [&](const std::string& lidar) {
    if (sequence.T_vehicle_lidar.contains(lidar)) {
      return false;
    }
    sequence.warnings.push_back(fmt::format("{}: '{}' is left out: it has no extrinsics", place.path.string(), lidar));
    return true;
  });
}

}  // namespace

AevaScenesSequence read_aevascenes_sequence(const std::filesystem::path& path) {
  AevaScenesSequence sequence;
  Place place{path, "metadata"};
  try {
    const std::string content = formats::read_text_file(path);
    const Json json = Json::parse(content);
    read_metadata(json.at("metadata"), sequence, place);
    place.where = "frames";
    const Json& frames = json.at("frames");
    for (std::size_t i = 0; i < frames.size(); ++i) {
      place.where = fmt::format("frame {}", i);
      sequence.frames.push_back(frame_of(frames.at(i), sequence, place));
    }
  } catch (const Json::exception& error) {
    place.fail(fmt::format("expected the metadata and frames of AevaScenes: {}", error.what()));
  }
  if (sequence.frames.empty()) {
    place.fail("no frames, expected at least one");
  }
  std::stable_sort(sequence.frames.begin(), sequence.frames.end(),
                   [](const AevaScenesFrame& a, const AevaScenesFrame& b) { return a.stamp < b.stamp; });
  for (std::size_t i = 1; i < sequence.frames.size(); ++i) {
    if (sequence.frames[i].stamp == sequence.frames[i - 1].stamp) {
      place.where = "frames";
      place.fail(
          fmt::format("two frames have the timestamp_ns {}, expected different ones", sequence.frames[i].stamp.ns));
    }
  }
  return sequence;
}

}  // namespace dynamic_icp::datasets
