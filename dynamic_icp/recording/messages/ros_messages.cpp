// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/ros_messages.hpp"

#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/messages/rigid_pose.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::size_t kPoseCovariance = 36;  // numbers; of a twist too
constexpr std::size_t kAxisCovariance = 9;
constexpr std::size_t kTwist = 6;
constexpr std::size_t kFloat = sizeof(float);

std::string frame_name(std::string_view name) { return std::string(name.starts_with('/') ? name.substr(1) : name); }

Stamp read_stamp(WireCursor& cursor) {
  // Unsigned in ROS 1.
  const std::int64_t seconds = cursor.is_ros1() ? std::int64_t{cursor.number<std::uint32_t>("header.stamp")}
                                                : std::int64_t{cursor.number<std::int32_t>("header.stamp")};
  return {seconds * kNanosecondsPerSecond + cursor.number<std::uint32_t>("header.stamp")};
}

/// The types of PointField; 9 and 10 are PCL's own.
FieldType field_type(std::uint8_t number, std::string_view field, const std::string& origin) {
  constexpr FieldType kTypes[] = {FieldType::kInt8,  FieldType::kUint8,  FieldType::kInt16,   FieldType::kUint16,
                                  FieldType::kInt32, FieldType::kUint32, FieldType::kFloat32, FieldType::kFloat64,
                                  FieldType::kInt64, FieldType::kUint64};
  if (number == 0 || number > std::size(kTypes)) {
    throw DataError(fmt::format("{}: field '{}' is of datatype {}, expected 1 to {} (8: FLOAT64)", origin, field,
                                number, std::size(kTypes)));
  }
  return kTypes[number - 1];
}

Eigen::Isometry3d read_pose(WireCursor& cursor, const std::string& origin, std::string_view field) {
  const Eigen::Vector3d position = cursor.vector(field);
  return rigid_pose(position, cursor.quaternion(field), origin, field);
}

StampedTransform read_one_transform(WireCursor& cursor, const std::string& origin) {
  StampedTransform transform;
  transform.header = read_header(cursor);
  transform.child_frame_id = frame_name(cursor.text("child_frame_id"));
  transform.T_parent_child = read_pose(cursor, origin, "transform");
  return transform;
}

void check_finite(const Eigen::Vector3d& vector, const std::string& origin, std::string_view field) {
  if (!vector.allFinite()) {
    throw DataError(fmt::format("{}: {} is ({}, {}, {}), expected finite numbers", origin, field, vector.x(),
                                vector.y(), vector.z()));
  }
}

/// Columns of float32, all of one length, as the points of a cloud.
void put_columns(const std::vector<std::string>& names, const std::vector<std::vector<float>>& columns,
                 PointCloud& cloud) {
  const std::size_t points = columns.front().size();
  cloud.width = static_cast<std::uint32_t>(points);
  cloud.point_step = static_cast<std::uint32_t>(kFloat * columns.size());
  cloud.row_step = std::uint64_t{cloud.point_step} * points;
  cloud.data.resize(cloud.row_step);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    cloud.fields.push_back({names[k], FieldType::kFloat32, static_cast<std::uint32_t>(kFloat * k), 1});
    for (std::size_t i = 0; i < points; ++i) {
      std::memcpy(cloud.data.data() + i * cloud.point_step + kFloat * k, &columns[k][i], kFloat);
    }
  }
}

}  // namespace

Header read_header(WireCursor& cursor) {
  if (cursor.is_ros1()) {
    cursor.number<std::uint32_t>("header.seq");
  }
  Header header;
  header.stamp = read_stamp(cursor);
  header.frame_id = frame_name(cursor.text("header.frame_id"));
  return header;
}

PointCloud read_point_cloud2(WireCursor cursor, const std::string& origin) {
  constexpr std::size_t kLeastFieldBytes = 13;
  PointCloud cloud;
  cloud.header = read_header(cursor);
  cloud.height = cursor.number<std::uint32_t>("height");
  cloud.width = cursor.number<std::uint32_t>("width");
  for (std::size_t left = cursor.count(kLeastFieldBytes, "fields"); left > 0; --left) {
    PointField field;
    field.name = cursor.text("fields.name");
    field.offset = cursor.number<std::uint32_t>("fields.offset");
    field.type = field_type(cursor.number<std::uint8_t>("fields.datatype"), field.name, origin);
    field.count = std::max(1U, cursor.number<std::uint32_t>("fields.count"));  // old writers leave a 0
    cloud.fields.push_back(std::move(field));
  }
  cloud.is_bigendian = cursor.number<std::uint8_t>("is_bigendian") != 0;
  cloud.point_step = cursor.number<std::uint32_t>("point_step");
  cloud.row_step = cursor.number<std::uint32_t>("row_step");
  cloud.data = cursor.bytes("data");
  cloud.is_dense = cursor.number<std::uint8_t>("is_dense") != 0;
  cursor.finish();
  return cloud;
}

PointCloud read_point_cloud1(WireCursor cursor, const std::string& origin) {
  constexpr std::size_t kPointBytes = 3 * kFloat;
  constexpr std::size_t kLeastChannelBytes = 8;
  PointCloud cloud;
  cloud.header = read_header(cursor);
  const std::size_t points = cursor.count(kPointBytes, "points");
  std::vector<std::vector<float>> columns(3, std::vector<float>(points));
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns[k][i] = cursor.number<float>("points");
    }
  }
  std::vector<std::string> names = {"x", "y", "z"};
  for (std::size_t left = cursor.count(kLeastChannelBytes, "channels"); left > 0; --left) {
    names.emplace_back(cursor.text("channels.name"));
    const std::size_t values = cursor.count(kFloat, "channels.values");
    if (values != points) {
      throw DataError(
          fmt::format("{}: channel '{}' has {} values for {} points", origin, names.back(), values, points));
    }
    columns.emplace_back(values);
    for (float& value : columns.back()) {
      value = cursor.number<float>("channels.values");
    }
  }
  cursor.finish();
  put_columns(names, columns, cloud);
  return cloud;
}

PointCloud read_radar_scan(WireCursor cursor, const std::string& /*origin*/) {
  static const std::vector<std::string> kNames = {
      "x", "y", "z", "range", "azimuth", "elevation", "doppler_velocity", "amplitude"};
  constexpr std::size_t kNumbers = 5;  // of a return
  PointCloud cloud;
  cloud.header = read_header(cursor);
  std::vector<std::vector<float>> columns(kNames.size());
  for (std::size_t left = cursor.count(kNumbers * kFloat, "returns"); left > 0; --left) {
    for (std::size_t k = 3; k < columns.size(); ++k) {
      columns[k].push_back(cursor.number<float>("returns"));
    }
    const double range = columns[3].back();
    const double azimuth = columns[4].back();
    const double elevation = columns[5].back();
    columns[0].push_back(static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)));
    columns[1].push_back(static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)));
    columns[2].push_back(static_cast<float>(range * std::sin(elevation)));
  }
  cursor.finish();
  put_columns(kNames, columns, cloud);
  return cloud;
}

StampedTransform read_pose_stamped(WireCursor cursor, const std::string& origin) {
  StampedTransform transform;
  transform.header = read_header(cursor);
  transform.T_parent_child = read_pose(cursor, origin, "pose");
  cursor.finish();
  return transform;
}

StampedTransform read_pose_with_covariance_stamped(WireCursor cursor, const std::string& origin) {
  StampedTransform transform;
  transform.header = read_header(cursor);
  transform.T_parent_child = read_pose(cursor, origin, "pose.pose");
  cursor.skip_doubles(kPoseCovariance, "pose.covariance");
  cursor.finish();
  return transform;
}

StampedTransform read_transform_stamped(WireCursor cursor, const std::string& origin) {
  StampedTransform transform = read_one_transform(cursor, origin);
  cursor.finish();
  return transform;
}

StampedTransform read_odometry(WireCursor cursor, const std::string& origin) {
  StampedTransform transform;
  transform.header = read_header(cursor);
  transform.child_frame_id = frame_name(cursor.text("child_frame_id"));
  transform.T_parent_child = read_pose(cursor, origin, "pose.pose");
  cursor.skip_doubles(kPoseCovariance, "pose.covariance");
  cursor.skip_doubles(kTwist + kPoseCovariance, "twist");
  cursor.finish();
  return transform;
}

std::vector<StampedTransform> read_transforms(WireCursor cursor, const std::string& origin) {
  constexpr std::size_t kLeastTransformBytes = 72;
  std::vector<StampedTransform> transforms;
  for (std::size_t left = cursor.count(kLeastTransformBytes, "transforms"); left > 0; --left) {
    transforms.push_back(read_one_transform(cursor, origin));
  }
  cursor.finish();
  return transforms;
}

Imu read_imu_message(WireCursor cursor, const std::string& origin) {
  Imu imu;
  imu.header = read_header(cursor);
  const Eigen::Quaterniond orientation = cursor.quaternion("orientation");
  const auto variance = cursor.number<double>("orientation_covariance");
  cursor.skip_doubles(kAxisCovariance - 1, "orientation_covariance");
  if (variance != -1.0 && is_rotation(orientation)) {  // many drivers leave four zeros instead of saying -1
    imu.orientation = orientation.normalized();
  }
  imu.angular_velocity = cursor.vector("angular_velocity");
  cursor.skip_doubles(kAxisCovariance, "angular_velocity_covariance");
  imu.linear_acceleration = cursor.vector("linear_acceleration");
  cursor.skip_doubles(kAxisCovariance, "linear_acceleration_covariance");
  cursor.finish();
  check_finite(imu.angular_velocity, origin, "angular_velocity");
  check_finite(imu.linear_acceleration, origin, "linear_acceleration");
  return imu;
}

}  // namespace dynamic_icp::messages
