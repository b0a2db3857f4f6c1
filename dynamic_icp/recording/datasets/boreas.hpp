// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// The folder of a Boreas recording with an Aeva sensor, up to three levels below `input`; empty when there is none.
std::filesystem::path find_boreas(const std::filesystem::path& input);

/// The same by the scans alone (aeva/*.bin or frames/*.bin), for when the user names the format.
std::filesystem::path find_boreas_scans(const std::filesystem::path& input);

/// Boreas-RT and Boreas-Aeva:
///   aeva/<stamp_us>.bin                 records of float32 (formats::kBoreas40; 24, 28 or 32 bytes: the content tells)
///   applanix/aeva_poses.csv             optional: poses of the sensor in ENU
///   calib/T_applanix_lidar.txt, T_aeva_lidar.txt   optional: give the sensor's pose in the Applanix frame
/// and the "Aeva" set of the same authors:
///   frames/*.bin                        records of 20 bytes (formats::kXyzdTime), in the order of their numbers
///   timestamps.txt                      seconds, one line per scan
///   aeva_poses.txt                      optional: 12 numbers of the sensor's 3x4 pose, one line per scan
std::unique_ptr<Dataset> open_boreas(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The poses of applanix/aeva_poses.csv: a header, then t (us), x, y, z, vx, vy, vz, roll, pitch, yaw, ... Throws
/// DataError naming file and line.
formats::Trajectory read_boreas_poses(const std::filesystem::path& path);

/// The times of timestamps.txt, strictly increasing. Throws DataError naming file and line.
std::vector<Stamp> read_boreas_times(const std::filesystem::path& path);

/// The transform in a file of calib/. Throws DataError naming the file.
Eigen::Isometry3d read_boreas_matrix(const std::filesystem::path& path);

}  // namespace dynamic_icp::datasets
