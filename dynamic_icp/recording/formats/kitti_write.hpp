// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::formats {

/// Poses as the odometry benchmark of KITTI has them: one line a pose with the twelve numbers of the first three rows
/// of T_world_sensor, row by row; without stamps. Numbers get as many digits as it takes to read back the same double.
/// The axes stay those of the sensor: nothing is turned to those of KITTI's camera.
std::string format_kitti(const Trajectory& trajectory);

/// Writes them whole or not at all. Throws DataError when the file cannot be written.
void write_kitti(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace dynamic_icp::formats
