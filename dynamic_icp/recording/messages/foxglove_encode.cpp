// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/foxglove_encode.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/recording/messages/protobuf_write.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr std::int64_t kEncodeSecond_ns = 1'000'000'000;

// How objects are drawn. Neutral, because the colours of the points mean something.
constexpr std::array<double, 4> kBoxColour = {0.85, 0.87, 0.92, 0.25};
constexpr std::array<double, 4> kArrowColour = {1.0, 1.0, 1.0, 0.95};
constexpr std::array<double, 4> kDoubtfulArrowColour = {1.0, 1.0, 1.0, 0.35};
constexpr std::array<double, 4> kTextColour = {1.0, 1.0, 1.0, 1.0};
constexpr double kArrowShaft_m = 0.12;
constexpr double kArrowHead_m = 0.4;
constexpr double kTextSize_px = 14.0;
constexpr double kTextAbove_m = 0.5;
constexpr double kSlowestArrow_mps = 0.3;

/// google.protobuf.Timestamp and Duration: the nanoseconds are never negative.
ProtobufWriter timestamp_message(std::int64_t ns) {
  std::int64_t seconds = ns / kEncodeSecond_ns;
  std::int64_t rest = ns % kEncodeSecond_ns;
  if (rest < 0) {
    --seconds;
    rest += kEncodeSecond_ns;
  }
  ProtobufWriter writer;
  writer.add_int(1, seconds);
  writer.add_int(2, rest);
  return writer;
}

ProtobufWriter vector3_message(const Eigen::Vector3d& vector) {
  ProtobufWriter writer;
  writer.add_double(1, vector.x());
  writer.add_double(2, vector.y());
  writer.add_double(3, vector.z());
  return writer;
}

ProtobufWriter quaternion_message(const Eigen::Quaterniond& rotation) {
  ProtobufWriter writer;
  writer.add_double(1, rotation.x());
  writer.add_double(2, rotation.y());
  writer.add_double(3, rotation.z());
  writer.add_double(4, rotation.w());
  return writer;
}

ProtobufWriter pose_message(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation) {
  ProtobufWriter writer;
  writer.add_message(1, vector3_message(position));
  writer.add_message(2, quaternion_message(orientation));
  return writer;
}

ProtobufWriter pose_message(const Eigen::Isometry3d& pose) {
  return pose_message(pose.translation(), Eigen::Quaterniond(pose.linear()).normalized());
}

ProtobufWriter colour_message(const std::array<double, 4>& rgba) {
  ProtobufWriter writer;
  for (std::uint32_t k = 0; k < rgba.size(); ++k) {
    writer.add_double(k + 1, rgba[k]);
  }
  return writer;
}

/// timestamp = 1 and frame_id = 2, with which most messages begin.
ProtobufWriter begin_message(const Header& header) {
  ProtobufWriter writer;
  writer.add_message(1, timestamp_message(header.stamp.ns));
  writer.add_bytes(2, header.frame_id);
  return writer;
}

/// foxglove.PackedElementField.NumericType.
std::uint64_t foxglove_type(const PointField& field) {
  switch (field.type) {
    case FieldType::kUint8:
      return 1;
    case FieldType::kInt8:
      return 2;
    case FieldType::kUint16:
      return 3;
    case FieldType::kInt16:
      return 4;
    case FieldType::kUint32:
      return 5;
    case FieldType::kInt32:
      return 6;
    case FieldType::kFloat32:
      return 7;
    case FieldType::kFloat64:
      return 8;
    case FieldType::kInt64:
    case FieldType::kUint64:
      break;
  }
  throw std::invalid_argument(
      fmt::format("field '{}' is of a type that foxglove.PointCloud does not have", field.name));
}

FieldType field_type_of(formats::NpyType type) {
  using formats::NpyType;
  switch (type) {
    case NpyType::kInt8:
      return FieldType::kInt8;
    case NpyType::kInt16:
      return FieldType::kInt16;
    case NpyType::kInt32:
      return FieldType::kInt32;
    case NpyType::kUint8:
      return FieldType::kUint8;
    case NpyType::kUint16:
      return FieldType::kUint16;
    case NpyType::kUint32:
      return FieldType::kUint32;
    case NpyType::kFloat32:
      return FieldType::kFloat32;
    case NpyType::kFloat64:
    case NpyType::kInt64:  // converted
    case NpyType::kUint64:
      break;
  }
  return FieldType::kFloat64;
}

ProtobufWriter arrow_message(const SceneObject& object) {
  const double speed = object.velocity.norm();
  ProtobufWriter writer;
  writer.add_message(1, pose_message(object.T_frame_box.translation(),
                                     Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), object.velocity)));
  writer.add_double(2, std::max(speed - kArrowHead_m, 0.0));
  writer.add_double(3, kArrowShaft_m);
  writer.add_double(4, std::min(speed, kArrowHead_m));
  writer.add_double(5, 0.75 * kArrowHead_m);
  writer.add_message(6, colour_message(object.is_velocity_known ? kArrowColour : kDoubtfulArrowColour));
  return writer;
}

ProtobufWriter cube_message(const SceneObject& object) {
  ProtobufWriter writer;
  writer.add_message(1, pose_message(object.T_frame_box));
  writer.add_message(2, vector3_message(object.size));
  writer.add_message(3, colour_message(kBoxColour));
  return writer;
}

ProtobufWriter text_message(const SceneObject& object) {
  const Eigen::Vector3d above(0.0, 0.0, 0.5 * object.size.z() + kTextAbove_m);
  ProtobufWriter writer;
  writer.add_message(1, pose_message(object.T_frame_box * above, Eigen::Quaterniond::Identity()));
  writer.add_varint(2, 1);  // turned to the viewer
  writer.add_double(3, kTextSize_px);
  writer.add_varint(4, 1);  // in pixels
  writer.add_message(5, colour_message(kTextColour));
  writer.add_bytes(6, object.text);
  return writer;
}

}  // namespace

PointCloud cloud_of_columns(const Header& header, std::span<const formats::NamedArray> columns) {
  PointCloud cloud;
  cloud.header = header;
  std::vector<std::string> converted(columns.size());
  std::vector<std::string_view> bytes;
  std::size_t rows = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const formats::NpyArray& array = columns[k].array;
    const std::size_t in_column = formats::rows_of(array);
    if (formats::columns_of(array) != 1 || (k > 0 && in_column != rows)) {
      throw std::invalid_argument(
          fmt::format("the column '{}' has {} rows for {} points", columns[k].name, in_column, rows));
    }
    rows = in_column;
    bytes.emplace_back(array.bytes);
    if (array.type == formats::NpyType::kInt64 || array.type == formats::NpyType::kUint64) {
      converted[k] = formats::array_of(formats::NpyType::kFloat64, {rows}, formats::column_as_doubles(array)).bytes;
      bytes.back() = converted[k];
    }
    const FieldType type = field_type_of(array.type);
    cloud.fields.push_back({columns[k].name, type, cloud.point_step, 1});
    cloud.point_step += type == FieldType::kFloat64 ? 8U : static_cast<std::uint32_t>(formats::size_of(array.type));
  }
  cloud.width = static_cast<std::uint32_t>(rows);
  cloud.row_step = std::uint64_t{cloud.point_step} * rows;
  cloud.data.resize(cloud.row_step);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t end = k + 1 < columns.size() ? cloud.fields[k + 1].offset : cloud.point_step;
    const std::size_t width = end - cloud.fields[k].offset;
    char* to = cloud.data.data() + cloud.fields[k].offset;
    const char* from = bytes[k].data();
    for (std::size_t row = 0; row < rows; ++row, to += cloud.point_step, from += width) {
      std::memcpy(to, from, width);
    }
  }
  return cloud;
}

std::string encode_cloud(const PointCloud& cloud) {
  if (cloud.is_bigendian) {
    throw std::invalid_argument("foxglove.PointCloud has little-endian numbers only");
  }
  ProtobufWriter writer = begin_message(cloud.header);
  writer.add_message(3, pose_message(cloud.T_frame_cloud.value_or(Eigen::Isometry3d::Identity())));
  writer.add_fixed32(4, cloud.point_step);
  for (const PointField& field : cloud.fields) {
    ProtobufWriter entry;
    entry.add_bytes(1, field.name);
    entry.add_fixed32(2, field.offset);
    entry.add_varint(3, foxglove_type(field));
    writer.add_message(5, entry);
  }
  writer.add_bytes(6, cloud.data);
  return writer.take();
}

std::string encode_transforms(std::span<const StampedTransform> transforms) {
  ProtobufWriter writer;
  for (const StampedTransform& transform : transforms) {
    ProtobufWriter entry = begin_message(transform.header);
    entry.add_bytes(3, transform.child_frame_id);
    entry.add_message(4, vector3_message(transform.T_parent_child.translation()));
    entry.add_message(5, quaternion_message(Eigen::Quaterniond(transform.T_parent_child.linear()).normalized()));
    writer.add_message(1, entry);
  }
  return writer.take();
}

std::string encode_pose(const Header& header, const Eigen::Isometry3d& pose) {
  ProtobufWriter writer = begin_message(header);
  writer.add_message(3, pose_message(pose));
  return writer.take();
}

std::string encode_poses(const Header& header, std::span<const Eigen::Isometry3d> poses) {
  ProtobufWriter writer = begin_message(header);
  for (const Eigen::Isometry3d& pose : poses) {
    writer.add_message(3, pose_message(pose));
  }
  return writer.take();
}

std::string encode_scene(const Header& header, std::span<const SceneObject> objects, double lifetime_s) {
  ProtobufWriter writer;
  ProtobufWriter deletion;
  deletion.add_message(1, timestamp_message(header.stamp.ns));
  deletion.add_varint(2, 1);  // all that there were
  writer.add_message(1, deletion);
  for (const SceneObject& object : objects) {
    ProtobufWriter entity = begin_message(header);
    entity.add_bytes(3, object.id);
    entity.add_message(4, timestamp_message(std::llround(lifetime_s * static_cast<double>(kEncodeSecond_ns))));
    if (object.velocity.norm() > kSlowestArrow_mps) {
      entity.add_message(7, arrow_message(object));
    }
    entity.add_message(8, cube_message(object));
    if (!object.text.empty()) {
      entity.add_message(13, text_message(object));
    }
    writer.add_message(2, entity);
  }
  return writer.take();
}

std::string encode_state(const OdometryState& state) {
  ProtobufWriter writer;
  writer.add_message(1, timestamp_message(state.stamp.ns));
  writer.add_bytes(2, state.status);
  writer.add_bytes(3, state.reason);
  writer.add_varint(4, state.converged ? 1 : 0);
  writer.add_double(5, state.ego_velocity_mps.norm());
  writer.add_message(6, vector3_message(state.ego_velocity_mps));
  writer.add_message(7, vector3_message(state.ego_velocity_sigma_mps));
  writer.add_message(8, vector3_message(state.position_sigma_m));
  writer.add_message(9, vector3_message(state.rotation_sigma_deg));
  writer.add_doubles(10, state.pose_covariance.data(), state.pose_covariance.size());
  writer.add_doubles(11, state.ego_velocity_covariance.data(), state.ego_velocity_covariance.size());
  writer.add_message(12, vector3_message(state.angular_velocity_dps));
  writer.add_double(13, state.doppler_bias_mps);
  writer.add_varint(14, state.points);
  writer.add_varint(15, state.points_used);
  writer.add_varint(16, state.moving_points);
  writer.add_varint(17, state.objects);
  writer.add_int(18, state.iterations);
  writer.add_double(19, state.inlier_rmse_m);
  writer.add_double(20, state.time_ms);
  writer.add_double(21, state.position_error_m);
  writer.add_double(22, state.latency_ms);
  return writer.take();
}

}  // namespace dynamic_icp::messages
