// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/messages.hpp"

#include <array>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

struct Kind {
  const char* type;
  bags::Encoding encoding;
};

constexpr std::array<Kind, 22> kKinds = {{{"sensor_msgs/PointCloud2", bags::Encoding::kRos1},
                                          {"sensor_msgs/PointCloud2", bags::Encoding::kCdr},
                                          {"sensor_msgs/PointCloud", bags::Encoding::kRos1},
                                          {"sensor_msgs/PointCloud", bags::Encoding::kCdr},
                                          {"foxglove.PointCloud", bags::Encoding::kProtobuf},
                                          {"foxglove.PointCloud", bags::Encoding::kJson},
                                          {"geometry_msgs/PoseStamped", bags::Encoding::kRos1},
                                          {"geometry_msgs/PoseWithCovarianceStamped", bags::Encoding::kCdr},
                                          {"geometry_msgs/TransformStamped", bags::Encoding::kCdr},
                                          {"nav_msgs/Odometry", bags::Encoding::kCdr},
                                          {"foxglove.PoseInFrame", bags::Encoding::kProtobuf},
                                          {"foxglove.PoseInFrame", bags::Encoding::kJson},
                                          {"tf2_msgs/TFMessage", bags::Encoding::kRos1},
                                          {"tf2_msgs/TFMessage", bags::Encoding::kCdr},
                                          {"foxglove.FrameTransforms", bags::Encoding::kProtobuf},
                                          {"foxglove.FrameTransforms", bags::Encoding::kJson},
                                          {"foxglove.FrameTransform", bags::Encoding::kProtobuf},
                                          {"foxglove.FrameTransform", bags::Encoding::kJson},
                                          {"sensor_msgs/Imu", bags::Encoding::kRos1},
                                          {"sensor_msgs/Imu", bags::Encoding::kCdr},
                                          {"radar_msgs/RadarScan", bags::Encoding::kRos1},
                                          {"radar_msgs/RadarScan", bags::Encoding::kCdr}}};

void read_message(const bags::Topic& topic, std::string_view bytes) {
  if (messages::is_cloud(topic)) {
    (void)messages::header_in_front(topic, bytes.substr(0, messages::kFrontBytes));
    const messages::CloudColumns columns(messages::decode_cloud(topic, bytes, "message"), "message");
    for (const std::string& name : columns.names()) {
      fuzz::must(columns.column(name).shape.front() == columns.points());
    }
  } else if (messages::is_pose(topic)) {
    fuzz::must(messages::decode_pose(topic, bytes, "message").T_parent_child.matrix().allFinite());
  } else if (messages::is_transforms(topic)) {
    for (const messages::StampedTransform& one : messages::decode_transforms(topic, bytes, "message")) {
      fuzz::must(one.T_parent_child.matrix().allFinite());
    }
  } else {
    fuzz::must(messages::decode_imu(topic, bytes, "message").angular_velocity.allFinite());
  }
}

}  // namespace

// The first byte says what the others are; any are read or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const Kind& kind = kKinds[data[0] % kKinds.size()];
  try {
    read_message({"/topic", kind.type, kind.encoding, "any", "", 1},
                 {reinterpret_cast<const char*>(data) + 1, size - 1});
  } catch (const DataError&) {
  }
  return 0;
}
