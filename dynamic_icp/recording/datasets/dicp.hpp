// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// Whether the folder (or one up to three levels below it) holds `point_clouds/*.bin`; the folder that does, or empty.
std::filesystem::path find_dicp(const std::filesystem::path& input);

/// The same, or else a folder of *.bin files or one named velodyne: for when the user names the format.
std::filesystem::path find_dicp_scans(const std::filesystem::path& input);

/// The layout of the Doppler-ICP data, which is also the plain one for interchange:
///   point_clouds/00001.bin ...  records of little-endian float32 x, y, z (m, sensor frame), Doppler (m/s, + away)
///   times/00001.bin ...         optional: float32 seconds after the stamp per point, for scans that take time
///   ref_poses.txt               optional: TUM rows, one per scan; gives the time stamps too
///   calibration.json            optional: pose of the sensor in the vehicle; ref_poses.txt then holds vehicle poses
/// Scans are ordered by the number in their file name. Without ref_poses.txt the names may be time stamps; else the
/// period of the options is assumed. A folder without point_clouds/ holds the scans itself.
std::unique_ptr<Dataset> open_dicp(const std::filesystem::path& folder, const OpenOptions& options = {});

/// T_vehicle_sensor from a calibration.json of this layout. Throws DataError naming the file and what was expected.
Eigen::Isometry3d read_calibration(const std::filesystem::path& path);

}  // namespace dynamic_icp::datasets
