// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// The folder of a recording of HeRCULES, up to three levels below `input`; empty when there is none.
std::filesystem::path find_hercules(const std::filesystem::path& input);

/// HeRCULES, in any spelling of upper and lower case and with its parts in one folder or several side by side:
///   LiDAR/Aeva/<stamp_ns>.bin    records of 29 bytes (formats::kAeva29); the stamp is the begin of the scan
///   PR_GT/Aeva_gt.txt            optional: poses of the sensor, TUM columns with whole nanoseconds
///   Calibration/IMU_LiDAR.txt    optional: pose of the sensor in the IMU, which stands for the vehicle
std::unique_ptr<Dataset> open_hercules(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The pose of the LiDAR in the IMU by Calibration/IMU_LiDAR.txt. Throws DataError naming file and line.
Eigen::Isometry3d read_imu_lidar(const std::filesystem::path& path);

}  // namespace dynamic_icp::datasets
