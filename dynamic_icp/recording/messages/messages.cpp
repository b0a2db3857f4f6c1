// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/messages.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/foxglove_messages.hpp"
#include "dynamic_icp/recording/messages/ros_messages.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr std::string_view kPointCloud2 = "sensor_msgs/PointCloud2";
constexpr std::string_view kPointCloud1 = "sensor_msgs/PointCloud";
constexpr std::string_view kRadarScan = "radar_msgs/RadarScan";
constexpr std::string_view kFoxgloveCloud = "foxglove.PointCloud";
constexpr std::string_view kImu = "sensor_msgs/Imu";

/// How messages of a type are read, of those that a wire format with the layout of ROS or Foxglove's two have.
template <class Message>
struct Decoder {
  std::string_view type;
  Message (*ros)(WireCursor cursor, const std::string& origin);
  Message (*protobuf)(std::string_view bytes, const std::string& origin);
  Message (*json)(std::string_view text, const std::string& origin);
};

using Transforms = std::vector<StampedTransform>;

Transforms one_protobuf_transform(std::string_view bytes, const std::string& origin) {
  return {read_protobuf_transform(bytes, origin)};
}

Transforms one_json_transform(std::string_view text, const std::string& origin) {
  return {read_json_transform(text, origin)};
}

constexpr std::array<Decoder<PointCloud>, 4> kCloudDecoders = {
    {{kPointCloud2, read_point_cloud2, nullptr, nullptr},
     {kPointCloud1, read_point_cloud1, nullptr, nullptr},
     {kRadarScan, read_radar_scan, nullptr, nullptr},
     {kFoxgloveCloud, nullptr, read_protobuf_cloud, read_json_cloud}}};

constexpr std::array<Decoder<StampedTransform>, 5> kPoseDecoders = {
    {{"geometry_msgs/PoseStamped", read_pose_stamped, nullptr, nullptr},
     {"geometry_msgs/PoseWithCovarianceStamped", read_pose_with_covariance_stamped, nullptr, nullptr},
     {"geometry_msgs/TransformStamped", read_transform_stamped, nullptr, nullptr},
     {"nav_msgs/Odometry", read_odometry, nullptr, nullptr},
     {"foxglove.PoseInFrame", nullptr, read_protobuf_pose, read_json_pose}}};

constexpr std::array<Decoder<Transforms>, 4> kTransformDecoders = {
    {{"tf2_msgs/TFMessage", read_transforms, nullptr, nullptr},
     {"tf/tfMessage", read_transforms, nullptr, nullptr},
     {"foxglove.FrameTransforms", nullptr, read_protobuf_transforms, read_json_transforms},
     {"foxglove.FrameTransform", nullptr, one_protobuf_transform, one_json_transform}}};

constexpr std::array<Decoder<Imu>, 1> kImuDecoders = {{{kImu, read_imu_message, nullptr, nullptr}}};

template <class Decoders>
auto find_decoder(const Decoders& decoders, const bags::Topic& topic) {
  const auto* const found = std::find_if(decoders.begin(), decoders.end(), [&](const auto& decoder) {
    switch (topic.encoding) {
      case bags::Encoding::kRos1:
      case bags::Encoding::kCdr:
        return decoder.type == topic.type && decoder.ros != nullptr;
      case bags::Encoding::kProtobuf:
        return decoder.type == topic.type && decoder.protobuf != nullptr;
      case bags::Encoding::kJson:
        return decoder.type == topic.type && decoder.json != nullptr;
      case bags::Encoding::kUnknown:
        break;
    }
    return false;
  });
  return found == decoders.end() ? nullptr : found;
}

WireCursor cursor_of(const bags::Topic& topic, std::string_view bytes, std::string_view origin) {
  return topic.encoding == bags::Encoding::kRos1 ? WireCursor::ros1(bytes, origin) : WireCursor::cdr(bytes, origin);
}

template <class Decoders>
auto decode(const Decoders& decoders, std::string_view what, const bags::Topic& topic, std::string_view bytes,
            const std::string& origin) {
  const auto* const decoder = find_decoder(decoders, topic);
  if (decoder == nullptr) {
    throw DataError(
        fmt::format("{}: {} of encoding '{}' is not read as {}", origin, topic.type, topic.encoding_name, what));
  }
  switch (topic.encoding) {
    case bags::Encoding::kProtobuf:
      return decoder->protobuf(bytes, origin);
    case bags::Encoding::kJson:
      return decoder->json(bytes, origin);
    default:
      return decoder->ros(cursor_of(topic, bytes, origin), origin);
  }
}

}  // namespace

bool is_cloud(const bags::Topic& topic) { return find_decoder(kCloudDecoders, topic) != nullptr; }
bool is_pose(const bags::Topic& topic) { return find_decoder(kPoseDecoders, topic) != nullptr; }
bool is_transforms(const bags::Topic& topic) { return find_decoder(kTransformDecoders, topic) != nullptr; }
bool is_imu(const bags::Topic& topic) { return find_decoder(kImuDecoders, topic) != nullptr; }

PointCloud decode_cloud(const bags::Topic& topic, std::string_view bytes, const std::string& origin) {
  return decode(kCloudDecoders, "a cloud of points", topic, bytes, origin);
}

std::optional<Header> header_in_front(const bags::Topic& topic, std::string_view front) {
  switch (topic.encoding) {
    case bags::Encoding::kProtobuf:
      return protobuf_cloud_header(front);
    case bags::Encoding::kRos1:
    case bags::Encoding::kCdr:
      try {
        WireCursor cursor = cursor_of(topic, front, "");
        return read_header(cursor);
      } catch (const DataError&) {
        return std::nullopt;
      }
    default:
      return std::nullopt;
  }
}

StampedTransform decode_pose(const bags::Topic& topic, std::string_view bytes, const std::string& origin) {
  return decode(kPoseDecoders, "a pose", topic, bytes, origin);
}

std::vector<StampedTransform> decode_transforms(const bags::Topic& topic, std::string_view bytes,
                                                const std::string& origin) {
  return decode(kTransformDecoders, "transforms", topic, bytes, origin);
}

Imu decode_imu(const bags::Topic& topic, std::string_view bytes, const std::string& origin) {
  return decode(kImuDecoders, "an Imu", topic, bytes, origin);
}

}  // namespace dynamic_icp::messages
