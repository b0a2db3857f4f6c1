// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/foxglove_schemas.hpp"

#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/recording/messages/protobuf_write.hpp"

namespace dynamic_icp::messages {
namespace {

/// FieldDescriptorProto.Type.
enum class SchemaType : std::uint8_t {
  kDouble = 1,
  kInt64 = 3,
  kInt32 = 5,
  kFixed32 = 7,
  kBool = 8,
  kString = 9,
  kMessage = 11,
  kBytes = 12,
  kUint32 = 13,
  kEnum = 14,
};

struct SchemaField {
  std::string_view name;
  std::uint32_t number = 0;
  SchemaType type = SchemaType::kDouble;
  std::string_view of = {};  ///< full name of a message, or name of an enum within the same one
  bool repeated = false;
};

/// An enum within a message: its values count from 0.
struct SchemaEnum {
  std::string_view name = {};
  std::vector<std::string_view> values = {};
};

/// A message in a file of its own, as Foxglove publishes them.
struct SchemaMessage {
  std::string_view package;
  std::string_view name;
  std::string_view file;
  std::vector<SchemaField> fields;
  SchemaEnum nested = {};
};

constexpr bool kRepeated = true;
constexpr std::string_view kTimestamp = "google.protobuf.Timestamp";
constexpr std::string_view kPose = "foxglove.Pose";
constexpr std::string_view kVector3 = "foxglove.Vector3";
constexpr std::string_view kColor = "foxglove.Color";
constexpr std::string_view kPoint3 = "foxglove.Point3";

std::vector<SchemaMessage> make_schema_messages() {
  using enum SchemaType;
  return {
      {"google.protobuf",
       "Timestamp",
       "google/protobuf/timestamp.proto",
       {{"seconds", 1, kInt64}, {"nanos", 2, kInt32}}},
      {"google.protobuf", "Duration", "google/protobuf/duration.proto", {{"seconds", 1, kInt64}, {"nanos", 2, kInt32}}},
      {"foxglove", "Vector3", "foxglove/Vector3.proto", {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}}},
      {"foxglove", "Point3", "foxglove/Point3.proto", {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}}},
      {"foxglove",
       "Quaternion",
       "foxglove/Quaternion.proto",
       {{"x", 1, kDouble}, {"y", 2, kDouble}, {"z", 3, kDouble}, {"w", 4, kDouble}}},
      {"foxglove",
       "Color",
       "foxglove/Color.proto",
       {{"r", 1, kDouble}, {"g", 2, kDouble}, {"b", 3, kDouble}, {"a", 4, kDouble}}},
      {"foxglove", "KeyValuePair", "foxglove/KeyValuePair.proto", {{"key", 1, kString}, {"value", 2, kString}}},
      {"foxglove",
       "Pose",
       "foxglove/Pose.proto",
       {{"position", 1, kMessage, kVector3}, {"orientation", 2, kMessage, "foxglove.Quaternion"}}},
      {"foxglove",
       "PoseInFrame",
       "foxglove/PoseInFrame.proto",
       {{"timestamp", 1, kMessage, kTimestamp}, {"frame_id", 2, kString}, {"pose", 3, kMessage, kPose}}},
      {"foxglove",
       "PosesInFrame",
       "foxglove/PosesInFrame.proto",
       {{"timestamp", 1, kMessage, kTimestamp}, {"frame_id", 2, kString}, {"poses", 3, kMessage, kPose, kRepeated}}},
      {"foxglove",
       "FrameTransform",
       "foxglove/FrameTransform.proto",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"parent_frame_id", 2, kString},
        {"child_frame_id", 3, kString},
        {"translation", 4, kMessage, kVector3},
        {"rotation", 5, kMessage, "foxglove.Quaternion"}}},
      {"foxglove",
       "FrameTransforms",
       "foxglove/FrameTransforms.proto",
       {{"transforms", 1, kMessage, "foxglove.FrameTransform", kRepeated}}},
      {"foxglove",
       "PackedElementField",
       "foxglove/PackedElementField.proto",
       {{"name", 1, kString}, {"offset", 2, kFixed32}, {"type", 3, kEnum, "NumericType"}},
       {"NumericType", {"UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32", "FLOAT64"}}},
      {"foxglove",
       "PointCloud",
       "foxglove/PointCloud.proto",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 2, kString},
        {"pose", 3, kMessage, kPose},
        {"point_stride", 4, kFixed32},
        {"fields", 5, kMessage, "foxglove.PackedElementField", kRepeated},
        {"data", 6, kBytes}}},
      {"foxglove",
       "ArrowPrimitive",
       "foxglove/ArrowPrimitive.proto",
       {{"pose", 1, kMessage, kPose},
        {"shaft_length", 2, kDouble},
        {"shaft_diameter", 3, kDouble},
        {"head_length", 4, kDouble},
        {"head_diameter", 5, kDouble},
        {"color", 6, kMessage, kColor}}},
      {"foxglove",
       "CubePrimitive",
       "foxglove/CubePrimitive.proto",
       {{"pose", 1, kMessage, kPose}, {"size", 2, kMessage, kVector3}, {"color", 3, kMessage, kColor}}},
      {"foxglove",
       "SpherePrimitive",
       "foxglove/SpherePrimitive.proto",
       {{"pose", 1, kMessage, kPose}, {"size", 2, kMessage, kVector3}, {"color", 3, kMessage, kColor}}},
      {"foxglove",
       "CylinderPrimitive",
       "foxglove/CylinderPrimitive.proto",
       {{"pose", 1, kMessage, kPose},
        {"size", 2, kMessage, kVector3},
        {"bottom_scale", 3, kDouble},
        {"top_scale", 4, kDouble},
        {"color", 5, kMessage, kColor}}},
      {"foxglove",
       "LinePrimitive",
       "foxglove/LinePrimitive.proto",
       {{"type", 1, kEnum, "Type"},
        {"pose", 2, kMessage, kPose},
        {"thickness", 3, kDouble},
        {"scale_invariant", 4, kBool},
        {"points", 5, kMessage, kPoint3, kRepeated},
        {"color", 6, kMessage, kColor},
        {"colors", 7, kMessage, kColor, kRepeated},
        {"indices", 8, kFixed32, {}, kRepeated}},
       {"Type", {"LINE_STRIP", "LINE_LOOP", "LINE_LIST"}}},
      {"foxglove",
       "TriangleListPrimitive",
       "foxglove/TriangleListPrimitive.proto",
       {{"pose", 1, kMessage, kPose},
        {"points", 2, kMessage, kPoint3, kRepeated},
        {"color", 3, kMessage, kColor},
        {"colors", 4, kMessage, kColor, kRepeated},
        {"indices", 5, kFixed32, {}, kRepeated}}},
      {"foxglove",
       "TextPrimitive",
       "foxglove/TextPrimitive.proto",
       {{"pose", 1, kMessage, kPose},
        {"billboard", 2, kBool},
        {"font_size", 3, kDouble},
        {"scale_invariant", 4, kBool},
        {"color", 5, kMessage, kColor},
        {"text", 6, kString}}},
      {"foxglove",
       "ModelPrimitive",
       "foxglove/ModelPrimitive.proto",
       {{"pose", 1, kMessage, kPose},
        {"scale", 2, kMessage, kVector3},
        {"color", 3, kMessage, kColor},
        {"override_color", 4, kBool},
        {"url", 5, kString},
        {"media_type", 6, kString},
        {"data", 7, kBytes}}},
      {"foxglove",
       "SceneEntity",
       "foxglove/SceneEntity.proto",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"frame_id", 2, kString},
        {"id", 3, kString},
        {"lifetime", 4, kMessage, "google.protobuf.Duration"},
        {"frame_locked", 5, kBool},
        {"metadata", 6, kMessage, "foxglove.KeyValuePair", kRepeated},
        {"arrows", 7, kMessage, "foxglove.ArrowPrimitive", kRepeated},
        {"cubes", 8, kMessage, "foxglove.CubePrimitive", kRepeated},
        {"spheres", 9, kMessage, "foxglove.SpherePrimitive", kRepeated},
        {"cylinders", 10, kMessage, "foxglove.CylinderPrimitive", kRepeated},
        {"lines", 11, kMessage, "foxglove.LinePrimitive", kRepeated},
        {"triangles", 12, kMessage, "foxglove.TriangleListPrimitive", kRepeated},
        {"texts", 13, kMessage, "foxglove.TextPrimitive", kRepeated},
        {"models", 14, kMessage, "foxglove.ModelPrimitive", kRepeated}}},
      {"foxglove",
       "SceneEntityDeletion",
       "foxglove/SceneEntityDeletion.proto",
       {{"timestamp", 1, kMessage, kTimestamp}, {"type", 2, kEnum, "Type"}, {"id", 3, kString}},
       {"Type", {"MATCHING_ID", "ALL"}}},
      {"foxglove",
       "SceneUpdate",
       "foxglove/SceneUpdate.proto",
       {{"deletions", 1, kMessage, "foxglove.SceneEntityDeletion", kRepeated},
        {"entities", 2, kMessage, "foxglove.SceneEntity", kRepeated}}},
      // What is plotted over time; see OdometryState.
      {"dynamic_icp",
       "OdometryState",
       "dynamic_icp/OdometryState.proto",
       {{"timestamp", 1, kMessage, kTimestamp},
        {"status", 2, kString},
        {"reason", 3, kString},
        {"converged", 4, kBool},
        {"speed_mps", 5, kDouble},
        {"ego_velocity_mps", 6, kMessage, kVector3},
        {"ego_velocity_sigma_mps", 7, kMessage, kVector3},
        {"position_sigma_m", 8, kMessage, kVector3},
        {"rotation_sigma_deg", 9, kMessage, kVector3},
        {"pose_covariance", 10, kDouble, {}, kRepeated},
        {"ego_velocity_covariance", 11, kDouble, {}, kRepeated},
        {"angular_velocity_dps", 12, kMessage, kVector3},
        {"doppler_bias_mps", 13, kDouble},
        {"points", 14, kUint32},
        {"points_used", 15, kUint32},
        {"moving_points", 16, kUint32},
        {"objects", 17, kUint32},
        {"iterations", 18, kInt32},
        {"inlier_rmse_m", 19, kDouble},
        {"time_ms", 20, kDouble},
        {"position_error_m", 21, kDouble},
        {"latency_ms", 22, kDouble}}},
  };
}

const std::vector<SchemaMessage>& schema_messages() {
  static const std::vector<SchemaMessage> messages = make_schema_messages();
  return messages;
}

std::string full_name(const SchemaMessage& message) { return fmt::format("{}.{}", message.package, message.name); }

const SchemaMessage& schema_message(std::string_view name) {
  for (const SchemaMessage& message : schema_messages()) {
    if (full_name(message) == name) {
      return message;
    }
  }
  throw std::out_of_range(fmt::format("no schema of '{}' is known", name));
}

/// FieldDescriptorProto.
ProtobufWriter field_descriptor(const SchemaMessage& message, const SchemaField& field) {
  constexpr std::uint64_t kOptional = 1;
  constexpr std::uint64_t kRepeatedLabel = 3;
  ProtobufWriter writer;
  writer.add_bytes(1, field.name);
  writer.add_varint(3, field.number);
  writer.add_varint(4, field.repeated ? kRepeatedLabel : kOptional);
  writer.add_varint(5, static_cast<std::uint64_t>(field.type));
  if (field.type == SchemaType::kMessage) {
    writer.add_bytes(6, fmt::format(".{}", field.of));
  } else if (field.type == SchemaType::kEnum) {
    writer.add_bytes(6, fmt::format(".{}.{}", full_name(message), field.of));
  }
  return writer;
}

/// EnumDescriptorProto.
ProtobufWriter enum_descriptor(const SchemaEnum& nested) {
  ProtobufWriter writer;
  writer.add_bytes(1, nested.name);
  for (std::size_t number = 0; number < nested.values.size(); ++number) {
    ProtobufWriter value;
    value.add_bytes(1, nested.values[number]);
    // Optional in proto2, in which descriptors are written: 0 is said as well.
    value.add_present_varint(2, number);
    writer.add_message(2, value);
  }
  return writer;
}

/// FileDescriptorProto.
ProtobufWriter file_descriptor(const SchemaMessage& message) {
  ProtobufWriter type;
  type.add_bytes(1, message.name);
  std::set<std::string_view> imports;
  for (const SchemaField& field : message.fields) {
    type.add_message(2, field_descriptor(message, field));
    if (field.type == SchemaType::kMessage) {
      imports.insert(schema_message(field.of).file);
    }
  }
  if (!message.nested.name.empty()) {
    type.add_message(4, enum_descriptor(message.nested));
  }
  ProtobufWriter file;
  file.add_bytes(1, message.file);
  file.add_bytes(2, message.package);
  for (const std::string_view import : imports) {
    file.add_bytes(3, import);
  }
  file.add_message(4, type);
  file.add_bytes(12, "proto3");
  return file;
}

/// A file comes after those that it imports.
void add_files(const SchemaMessage& message, std::set<std::string_view>& added, ProtobufWriter& set) {
  if (!added.insert(message.file).second) {
    return;
  }
  for (const SchemaField& field : message.fields) {
    if (field.type == SchemaType::kMessage) {
      add_files(schema_message(field.of), added, set);
    }
  }
  set.add_message(1, file_descriptor(message));
}

}  // namespace

std::string protobuf_schema(std::string_view message) {
  ProtobufWriter set;
  std::set<std::string_view> added;
  add_files(schema_message(message), added, set);
  return set.take();
}

}  // namespace dynamic_icp::messages
