// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/mcap_target.hpp"

#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/messages/foxglove_encode.hpp"
#include "dynamic_icp/recording/messages/foxglove_schemas.hpp"

namespace dynamic_icp::conversion {
namespace {

constexpr const char* kWorldFrame = "world";
constexpr const char* kVehicleFrame = "base_link";
constexpr const char* kSensorFrame = "sensor";  // of a rig: the common frame of its points

constexpr const char* kCalibrationSchema =
    R"({"title": "dynamic_icp.Calibration", "type": "object", "properties": {)"
    R"("T_V_to_S": {"type": "object", "description": "pose of the frame of the points on the vehicle"}, )"
    R"("sensors": {"type": "array", "description": "poses of the sensors of a rig in the frame of the points", )"
    R"("items": {"type": "object"}}}})";

bags::McapSettings mcap_settings() {
  bags::McapSettings settings;
  settings.library = fmt::format("dynamic-icp {}", version());
  return settings;
}

std::uint16_t add_mcap_channel(bags::McapWriter& writer, const char* topic, const char* type) {
  const std::uint16_t schema = writer.add_schema({type, "protobuf", messages::protobuf_schema(type)});
  return writer.add_channel({schema, topic, "protobuf", {}});
}

}  // namespace

McapTarget::McapTarget(const std::filesystem::path& file, const datasets::Dataset& dataset,
                       const datasets::Calibration& calibration)
    : file_(file),
      writer_([this](std::string_view bytes) { file_.write(bytes); }, mcap_settings()),
      truth_(dataset.ground_truth()),
      calibration_(calibration) {
  const bool is_compensated = dataset.doppler_kind() == DopplerKind::kCompensated;
  points_ = add_mcap_channel(writer_, is_compensated ? kMcapCompensatedPoints : kMcapPoints, messages::kPointCloudType);
  const bool has_mounting = calibration.T_vehicle_sensor || !calibration.mountings.empty();
  if (!truth_.empty()) {
    truth_pose_ = add_mcap_channel(writer_, kMcapTruthPose, messages::kPoseInFrameType);
    truth_path_ = add_mcap_channel(writer_, kMcapTruthPath, messages::kPosesInFrameType);
  }
  if (!truth_.empty() || has_mounting) {
    const std::uint16_t schema = writer_.add_schema(
        {messages::kFrameTransformsType, "protobuf", messages::protobuf_schema(messages::kFrameTransformsType)});
    if (!truth_.empty()) {
      transforms_ = writer_.add_channel({schema, kMcapTransforms, "protobuf", {}});
    }
    if (has_mounting) {
      static_transforms_ = writer_.add_channel({schema, kMcapStaticTransforms, "protobuf", {}});
      const std::uint16_t text = writer_.add_schema({kMcapCalibrationType, "jsonschema", kCalibrationSchema});
      calibration_channel_ = writer_.add_channel({text, kMcapCalibration, "json", {}});
    }
  }
  writer_.add_metadata("dynamic_icp.conversion",
                       {{"version", std::string(version())}, {"source_format", std::string(dataset.format())}});
}

/// What holds for all of the recording, at the time of its first message.
void McapTarget::write_start(Stamp stamp) {
  started_ = true;
  if (calibration_.T_vehicle_sensor || !calibration_.mountings.empty()) {
    writer_.write(calibration_channel_, stamp, datasets::calibration_text(calibration_));
    std::vector<messages::StampedTransform> transforms;
    if (calibration_.T_vehicle_sensor) {
      transforms.push_back({{stamp, kVehicleFrame}, kSensorFrame, *calibration_.T_vehicle_sensor});
    }
    for (std::size_t k = 0; k < calibration_.mountings.size(); ++k) {
      transforms.push_back({{stamp, kSensorFrame}, fmt::format("sensor_{}", k), calibration_.mountings[k]});
    }
    writer_.write(static_transforms_, stamp, messages::encode_transforms(transforms));
  }
  if (!truth_.empty()) {
    std::vector<Eigen::Isometry3d> path;
    path.reserve(truth_.size());
    for (const formats::StampedPose& pose : truth_) {
      path.push_back(pose.T_world_sensor);
    }
    writer_.write(truth_path_, stamp, messages::encode_poses({stamp, kWorldFrame}, path));
  }
}

void McapTarget::write_truth_until(std::optional<Stamp> end, Notes& notes) {
  // The vehicle moves in the world and carries the sensor: a frame has one parent.
  const char* child = calibration_.T_vehicle_sensor ? kVehicleFrame : kSensorFrame;
  const Eigen::Isometry3d T_sensor_child = calibration_.T_vehicle_sensor
                                               ? Eigen::Isometry3d(calibration_.T_vehicle_sensor->inverse())
                                               : Eigen::Isometry3d::Identity();
  for (; next_pose_ < truth_.size() && (!end || truth_[next_pose_].stamp <= *end); ++next_pose_) {
    const formats::StampedPose& pose = truth_[next_pose_];
    if (pose.stamp.ns < 0) {
      notes.add("poses of the ground truth before 1970 are left out: mcap has no times for them");
      continue;
    }
    const messages::Header header{pose.stamp, kWorldFrame};
    writer_.write(truth_pose_, pose.stamp, messages::encode_pose(header, pose.T_world_sensor));
    const messages::StampedTransform transform{header, child, pose.T_world_sensor * T_sensor_child};
    writer_.write(transforms_, pose.stamp, messages::encode_transforms({&transform, 1}));
  }
}

void McapTarget::add(Stamp stamp, const ScanToWrite& scan, Notes& notes) {
  if (stamp.ns < 0) {
    throw DataError(fmt::format("a scan is at {} s, expected a time from 0 on: mcap has no times before 1970",
                                format_seconds(stamp)));
  }
  if (!started_) {
    const bool truth_first = !truth_.empty() && truth_.front().stamp.ns >= 0 && truth_.front().stamp < stamp;
    write_start(truth_first ? truth_.front().stamp : stamp);
  }
  write_truth_until(stamp, notes);
  const std::vector<formats::NamedArray> table = scan_table(scan, false, notes);
  for (const formats::NamedArray& column : table) {
    if (column.array.type == formats::NpyType::kInt64) {
      // Read as a double from the recording, so that as a double it loses nothing.
      notes.add(
          fmt::format("column '{}' is written as float64: clouds of mcap have no integers of 64 bits", column.name));
    }
  }
  writer_.write(points_, stamp, messages::encode_cloud(messages::cloud_of_columns({stamp, kSensorFrame}, table)));
}

void McapTarget::finish(Notes& notes) {
  write_truth_until(std::nullopt, notes);
  writer_.finish();
  file_.commit();
}

}  // namespace dynamic_icp::conversion
