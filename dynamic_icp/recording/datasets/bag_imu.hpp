// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {

/// The measurements of an IMU, in the order of their strictly increasing stamps.
struct ImuRecording {
  std::string topic;
  std::vector<messages::Imu> measurements;  ///< header.stamp: that of the header where sane, else of the recording
  std::vector<std::string> assumptions;  ///< how stamps were chosen and what was left out (as of clouds), in sentences
};

/// Reads the sensor_msgs/Imu messages of a topic; without a name, of the only one that has some. Throws UsageError
/// where there is no such topic or several could be meant, naming those there are, and DataError naming the message
/// that is damaged.
ImuRecording read_imu(const bags::Bag& bag, const std::string& topic = {});

/// The same of the bag that a file or folder is or holds (bags::find_bag). Throws DataError where there is none, too.
ImuRecording read_imu(const std::filesystem::path& input, const std::string& topic = {});

}  // namespace dynamic_icp::datasets
