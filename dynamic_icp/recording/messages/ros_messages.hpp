// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/recording/messages/messages.hpp"
#include "dynamic_icp/recording/messages/wire_cursor.hpp"

// The messages of ROS 1 and ROS 2, whose definitions differ by header.seq only. Each function reads a whole message and
// throws DataError as the cursor does.
namespace dynamic_icp::messages {

Header read_header(WireCursor& cursor);

PointCloud read_point_cloud2(WireCursor cursor, const std::string& origin);

/// sensor_msgs/PointCloud: points of three float32, and channels of one number each.
PointCloud read_point_cloud1(WireCursor cursor, const std::string& origin);

/// radar_msgs/RadarScan: range, azimuth (counter-clockwise) and elevation of each return, rad, with Doppler and
/// amplitude, float32; x, y, z in front of them.
PointCloud read_radar_scan(WireCursor cursor, const std::string& origin);

StampedTransform read_pose_stamped(WireCursor cursor, const std::string& origin);
StampedTransform read_pose_with_covariance_stamped(WireCursor cursor, const std::string& origin);
StampedTransform read_transform_stamped(WireCursor cursor, const std::string& origin);
StampedTransform read_odometry(WireCursor cursor, const std::string& origin);
std::vector<StampedTransform> read_transforms(WireCursor cursor, const std::string& origin);
Imu read_imu_message(WireCursor cursor, const std::string& origin);

}  // namespace dynamic_icp::messages
