// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/foxglove_messages.hpp"
#include "dynamic_icp/recording/messages/protobuf_cursor.hpp"
#include "dynamic_icp/recording/messages/rigid_pose.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr std::uint64_t kNanosecondsInSecond = 1'000'000'000;

/// google.protobuf.Timestamp. Numbers that are 0 are left out in protobuf, here and below.
Stamp stamp_in(ProtobufCursor timestamp) {
  std::uint64_t seconds = 0;
  std::uint64_t nanoseconds = 0;
  while (timestamp.next()) {
    if (timestamp.number() == 1) {
      seconds = timestamp.varint();
    } else if (timestamp.number() == 2) {
      nanoseconds = timestamp.varint();
    }
  }
  // Unsigned, so that seconds that nobody measured overflow in a defined way.
  return {static_cast<std::int64_t>(seconds * kNanosecondsInSecond + nanoseconds)};
}

Eigen::Vector4d numbers_in_message(ProtobufCursor message) {
  Eigen::Vector4d numbers = Eigen::Vector4d::Zero();
  while (message.next()) {
    if (message.number() >= 1 && message.number() <= 4) {
      numbers[static_cast<Eigen::Index>(message.number()) - 1] = message.fixed64();
    }
  }
  return numbers;
}

/// Position and orientation, fields of the given numbers. What is not there, or all zeros, is no translation and no
/// rotation: protobuf writes both in the same way.
struct PoseNumbers {
  Eigen::Vector4d position = Eigen::Vector4d::Zero();
  Eigen::Vector4d orientation = Eigen::Vector4d::Zero();  ///< x, y, z, w

  [[nodiscard]] Eigen::Isometry3d pose(const std::string& origin, std::string_view field) const {
    const Eigen::Vector4d xyzw = orientation.isZero(0.0) ? Eigen::Vector4d::Unit(3) : orientation;
    return rigid_pose(position.head<3>(), Eigen::Quaterniond(xyzw), origin, field);
  }
};

PoseNumbers pose_numbers(ProtobufCursor pose) {
  PoseNumbers numbers;
  while (pose.next()) {
    if (pose.number() == 1) {
      numbers.position = numbers_in_message(pose.message());
    } else if (pose.number() == 2) {
      numbers.orientation = numbers_in_message(pose.message());
    }
  }
  return numbers;
}

PointField field_in(ProtobufCursor message, const std::string& origin) {
  PointField field;
  std::uint64_t type = 0;
  while (message.next()) {
    switch (message.number()) {
      case 1:
        field.name = message.bytes();
        break;
      case 2:
        field.offset = message.fixed32();
        break;
      case 3:
        type = message.varint();
        break;
      default:
        break;
    }
  }
  field.type = foxglove_field_type(type, field.name, origin);
  return field;
}

StampedTransform transform_in(ProtobufCursor message, const std::string& origin) {
  StampedTransform transform;
  PoseNumbers numbers;
  while (message.next()) {
    switch (message.number()) {
      case 1:
        transform.header.stamp = stamp_in(message.message());
        break;
      case 2:
        transform.header.frame_id = message.bytes();
        break;
      case 3:
        transform.child_frame_id = message.bytes();
        break;
      case 4:
        numbers.position = numbers_in_message(message.message());
        break;
      case 5:
        numbers.orientation = numbers_in_message(message.message());
        break;
      default:
        break;
    }
  }
  transform.T_parent_child = numbers.pose(origin, "transform");
  return transform;
}

}  // namespace

FieldType foxglove_field_type(std::uint64_t number, std::string_view field, const std::string& origin) {
  constexpr FieldType kTypes[] = {FieldType::kUint8,  FieldType::kInt8,  FieldType::kUint16,  FieldType::kInt16,
                                  FieldType::kUint32, FieldType::kInt32, FieldType::kFloat32, FieldType::kFloat64};
  if (number == 0 || number > std::size(kTypes)) {
    throw DataError(fmt::format("{}: field '{}' is of type {}, expected 1 to {} (8: FLOAT64)", origin, field, number,
                                std::size(kTypes)));
  }
  return kTypes[number - 1];
}

void set_width(PointCloud& cloud, const std::string& origin) {
  if (cloud.data.empty()) {
    return;
  }
  if (cloud.point_step == 0 || cloud.data.size() % cloud.point_step != 0) {
    throw DataError(fmt::format("{}: {} bytes of data are no multiple of point_stride, {} bytes", origin,
                                cloud.data.size(), cloud.point_step));
  }
  const std::size_t points = cloud.data.size() / cloud.point_step;
  if (points > UINT32_MAX) {
    throw DataError(fmt::format("{}: {} points, expected fewer", origin, points));
  }
  cloud.width = static_cast<std::uint32_t>(points);
  cloud.row_step = cloud.data.size();
}

PointCloud read_protobuf_cloud(std::string_view bytes, const std::string& origin) {
  PointCloud cloud;
  for (ProtobufCursor message(bytes, origin); message.next();) {
    switch (message.number()) {
      case 1:
        cloud.header.stamp = stamp_in(message.message());
        break;
      case 2:
        cloud.header.frame_id = message.bytes();
        break;
      case 3:
        cloud.T_frame_cloud = pose_numbers(message.message()).pose(origin, "pose");
        break;
      case 4:
        cloud.point_step = message.fixed32();
        break;
      case 5:
        cloud.fields.push_back(field_in(message.message(), origin));
        break;
      case 6:
        cloud.data = message.bytes();
        break;
      default:
        break;
    }
  }
  set_width(cloud, origin);
  return cloud;
}

std::optional<Header> protobuf_cloud_header(std::string_view front) {
  Header header;
  bool has_stamp = false;
  bool has_frame = false;
  try {
    ProtobufCursor message(front, "");
    // Fields are written in the order of their numbers, but none must be.
    while (!(has_stamp && has_frame) && message.next()) {
      if (message.number() == 1) {
        header.stamp = stamp_in(message.message());
        has_stamp = true;
      } else if (message.number() == 2) {
        header.frame_id = message.bytes();
        has_frame = true;
      }
    }
  } catch (const DataError&) {
    return std::nullopt;  // the front ends within a field
  }
  return has_stamp && has_frame ? std::optional(header) : std::nullopt;
}

StampedTransform read_protobuf_pose(std::string_view bytes, const std::string& origin) {
  StampedTransform transform;
  PoseNumbers numbers;
  for (ProtobufCursor message(bytes, origin); message.next();) {
    if (message.number() == 1) {
      transform.header.stamp = stamp_in(message.message());
    } else if (message.number() == 2) {
      transform.header.frame_id = message.bytes();
    } else if (message.number() == 3) {
      numbers = pose_numbers(message.message());
    }
  }
  transform.T_parent_child = numbers.pose(origin, "pose");
  return transform;
}

StampedTransform read_protobuf_transform(std::string_view bytes, const std::string& origin) {
  return transform_in(ProtobufCursor(bytes, origin), origin);
}

std::vector<StampedTransform> read_protobuf_transforms(std::string_view bytes, const std::string& origin) {
  std::vector<StampedTransform> transforms;
  for (ProtobufCursor message(bytes, origin); message.next();) {
    if (message.number() == 1) {
      transforms.push_back(transform_in(message.message(), origin));
    }
  }
  return transforms;
}

}  // namespace dynamic_icp::messages
