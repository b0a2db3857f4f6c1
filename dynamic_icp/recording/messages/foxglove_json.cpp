// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/base64.hpp"
#include "dynamic_icp/recording/messages/foxglove_messages.hpp"
#include "dynamic_icp/recording/messages/rigid_pose.hpp"

namespace dynamic_icp::messages {
namespace {

using Json = nlohmann::json;

/// A value of a message, and what messages to the user call it.
class Value {
 public:
  Value(const Json* json, const std::string& origin, std::string name)
      : json_(json), origin_(origin), name_(std::move(name)) {}

  /// The member of that name; missing ones and null are values that do not exist.
  [[nodiscard]] Value at(const char* key) const {
    const Json* const found = json_ != nullptr && json_->is_object() && json_->contains(key) ? &(*json_)[key] : nullptr;
    return {found == nullptr || found->is_null() ? nullptr : found, origin_,
            name_.empty() ? std::string(key) : name_ + '.' + key};
  }

  [[nodiscard]] bool exists() const { return json_ != nullptr; }

  [[nodiscard]] std::uint64_t whole() const {
    if (json_ == nullptr || !json_->is_number_integer() || *json_ < 0) {
      fail("a whole number from 0 on");
    }
    return json_->get<std::uint64_t>();
  }

  [[nodiscard]] std::uint32_t whole32() const {
    const std::uint64_t number = whole();
    if (number > UINT32_MAX) {
      fail("a number below 2^32");
    }
    return static_cast<std::uint32_t>(number);
  }

  [[nodiscard]] double number() const {
    if (json_ == nullptr || !json_->is_number()) {
      fail("a number");
    }
    return json_->get<double>();
  }

  [[nodiscard]] const std::string& text() const {
    if (!is_text()) {
      fail("a text");
    }
    return json_->get_ref<const std::string&>();
  }

  [[nodiscard]] std::vector<Value> items() const {
    if (json_ == nullptr || !json_->is_array()) {
      fail("a list");
    }
    std::vector<Value> items;
    for (const Json& item : *json_) {
      items.emplace_back(&item, origin_, fmt::format("{}[{}]", name_, items.size()));
    }
    return items;
  }

  [[nodiscard]] bool is_text() const { return json_ != nullptr && json_->is_string(); }

  [[noreturn]] void fail(std::string_view expected) const {
    throw DataError(fmt::format("{}: JSON: {} {}, expected {}", origin_, name_,
                                json_ == nullptr ? "is missing" : fmt::format("is of type {}", json_->type_name()),
                                expected));
  }

 private:
  const Json* json_;
  const std::string& origin_;
  std::string name_;
};

Json parse_message(std::string_view text, const std::string& origin) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("{}: is no JSON: {}", origin, error.what()));
  }
}

Stamp json_stamp(const Value& time) {
  // Unsigned, so that seconds that nobody measured overflow in a defined way.
  return {static_cast<std::int64_t>(time.at("sec").whole() * 1'000'000'000U + time.at("nsec").whole())};
}

Eigen::Vector3d json_vector(const Value& vector) {
  return {vector.at("x").number(), vector.at("y").number(), vector.at("z").number()};
}

Eigen::Quaterniond json_quaternion(const Value& q) {
  return {q.at("w").number(), q.at("x").number(), q.at("y").number(), q.at("z").number()};
}

FieldType json_field_type(const Value& type, const std::string& field, const std::string& origin) {
  constexpr std::array<std::string_view, 9> kNames = {"UNKNOWN", "UINT8", "INT8",    "UINT16", "INT16",
                                                      "UINT32",  "INT32", "FLOAT32", "FLOAT64"};
  if (!type.is_text()) {
    return foxglove_field_type(type.whole(), field, origin);
  }
  const auto* const found = std::find(kNames.begin(), kNames.end(), type.text());
  if (found == kNames.end()) {
    type.fail("a number from 1 to 8 or a name such as FLOAT32");
  }
  return foxglove_field_type(static_cast<std::uint64_t>(found - kNames.begin()), field, origin);
}

StampedTransform json_transform(const Value& message, const std::string& origin) {
  StampedTransform transform;
  transform.header = {json_stamp(message.at("timestamp")), message.at("parent_frame_id").text()};
  transform.child_frame_id = message.at("child_frame_id").text();
  transform.T_parent_child =
      rigid_pose(json_vector(message.at("translation")), json_quaternion(message.at("rotation")), origin, "transform");
  return transform;
}

Eigen::Isometry3d json_pose(const Value& pose, const std::string& origin) {
  return rigid_pose(json_vector(pose.at("position")), json_quaternion(pose.at("orientation")), origin, "pose");
}

}  // namespace

PointCloud read_json_cloud(std::string_view text, const std::string& origin) {
  const Json json = parse_message(text, origin);
  const Value message(&json, origin, "");
  PointCloud cloud;
  cloud.header = {json_stamp(message.at("timestamp")), message.at("frame_id").text()};
  if (const Value pose = message.at("pose"); pose.exists()) {
    cloud.T_frame_cloud = json_pose(pose, origin);
  }
  cloud.point_step = message.at("point_stride").whole32();
  for (const Value& item : message.at("fields").items()) {
    PointField field;
    field.name = item.at("name").text();
    field.offset = item.at("offset").whole32();
    field.type = json_field_type(item.at("type"), field.name, origin);
    cloud.fields.push_back(std::move(field));
  }
  const Value data = message.at("data");
  std::optional<std::string> bytes = formats::bytes_of_base64(data.text());
  if (!bytes) {
    data.fail("a text of base64");
  }
  cloud.data = std::move(*bytes);
  set_width(cloud, origin);
  return cloud;
}

StampedTransform read_json_pose(std::string_view text, const std::string& origin) {
  const Json json = parse_message(text, origin);
  const Value message(&json, origin, "");
  StampedTransform transform;
  transform.header = {json_stamp(message.at("timestamp")), message.at("frame_id").text()};
  transform.T_parent_child = json_pose(message.at("pose"), origin);
  return transform;
}

StampedTransform read_json_transform(std::string_view text, const std::string& origin) {
  const Json json = parse_message(text, origin);
  return json_transform(Value(&json, origin, ""), origin);
}

std::vector<StampedTransform> read_json_transforms(std::string_view text, const std::string& origin) {
  const Json json = parse_message(text, origin);
  std::vector<StampedTransform> transforms;
  for (const Value& item : Value(&json, origin, "").at("transforms").items()) {
    transforms.push_back(json_transform(item, origin));
  }
  return transforms;
}

}  // namespace dynamic_icp::messages
