// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"

// The messages of robots that say something to odometry, decoded from the bytes of ROS 1, of CDR (ROS 2), of protobuf
// and of JSON (Foxglove's schemas). Each function throws DataError that begins with `origin` (the message's file, topic
// and number) and names the field, where bytes are too few, lengths contradict each other or a rotation is none.
// Nothing is allocated by a length before that many bytes are there.
namespace dynamic_icp::messages {

struct Header {
  Stamp stamp;           ///< 0 where the sender left it empty
  std::string frame_id;  ///< without the slash in front that ROS 1 may have
};

/// The types of a point's fields. PointField and Foxglove's NumericType number them in different ways.
enum class FieldType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64,
  kInt64,
  kUint64
};

struct PointField {
  std::string name;
  FieldType type = FieldType::kFloat32;
  std::uint32_t offset = 0;  ///< bytes from the begin of a point
  std::uint32_t count = 1;
};

/// A cloud of points, not yet taken apart (cloud_columns.hpp does): sensor_msgs/PointCloud2, sensor_msgs/PointCloud or
/// foxglove.PointCloud.
struct PointCloud {
  Header header;
  std::vector<PointField> fields;
  std::uint32_t width = 0;  ///< points of a row
  std::uint32_t height = 1;
  std::uint32_t point_step = 0;  ///< bytes
  std::uint64_t row_step = 0;
  bool is_bigendian = false;
  bool is_dense = true;
  std::optional<Eigen::Isometry3d> T_frame_cloud;  ///< foxglove.PointCloud: where the points' origin is in the frame
  std::string data;
};

struct StampedTransform {
  Header header;               ///< frame_id: the parent
  std::string child_frame_id;  ///< empty where the message does not name it
  Eigen::Isometry3d T_parent_child = Eigen::Isometry3d::Identity();
};

struct Imu {
  Header header;
  std::optional<Eigen::Quaterniond> orientation;                  ///< empty where the message has none
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     ///< rad/s, sensor frame
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  ///< m/s^2, sensor frame
};

/// Whether `decode_cloud` reads messages of this topic; the same of the others.
bool is_cloud(const bags::Topic& topic);
bool is_pose(const bags::Topic& topic);
bool is_transforms(const bags::Topic& topic);
bool is_imu(const bags::Topic& topic);

/// sensor_msgs/PointCloud2, sensor_msgs/PointCloud (its channels as fields of float32), foxglove.PointCloud.
PointCloud decode_cloud(const bags::Topic& topic, std::string_view bytes, const std::string& origin);

/// As many bytes from the front of a message as are worth a look for its header.
constexpr std::size_t kFrontBytes = 1024;

/// The header of a cloud by the front of its message. Nothing where the front does not tell: the header is long, or may
/// be anywhere as in JSON.
std::optional<Header> header_in_front(const bags::Topic& topic, std::string_view front);

/// geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped, nav_msgs/Odometry, foxglove.PoseInFrame: the
/// pose of the child in the frame of the header.
StampedTransform decode_pose(const bags::Topic& topic, std::string_view bytes, const std::string& origin);

/// tf2_msgs/TFMessage, tf/tfMessage, foxglove.FrameTransforms, foxglove.FrameTransform.
std::vector<StampedTransform> decode_transforms(const bags::Topic& topic, std::string_view bytes,
                                                const std::string& origin);

/// sensor_msgs/Imu. Throws for rates and accelerations that are not finite, too.
Imu decode_imu(const bags::Topic& topic, std::string_view bytes, const std::string& origin);

}  // namespace dynamic_icp::messages
