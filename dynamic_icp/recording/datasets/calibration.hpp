// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace dynamic_icp::datasets {

/// The name of the file beside the scans that says where their sensors sit.
inline constexpr const char* kCalibrationFile = "calibration.json";

/// What it says; at least one of them.
struct Calibration {
  std::optional<Eigen::Isometry3d> T_vehicle_sensor;  ///< of a rig: of the common frame of its sensors
  std::vector<Eigen::Isometry3d> mountings;           ///< of a rig: T_scan_sensor by the numbers of its sensors
};

/// Reads such a file:
///   {"T_V_to_S": T, "sensors": [{"T_scan_sensor": T}, ...]}, T = {"translation": {x, y, z}, "quaternion": {w, x, y,
///   z}}
/// The first, of the Doppler-ICP data, maps points of the sensor to the vehicle in spite of its name. Either may be
/// missing. Throws DataError naming the file and what was expected.
Calibration read_calibration(const std::filesystem::path& path);

/// The same of a text that stands elsewhere; `origin` is what messages name.
Calibration parse_calibration(const std::string& text, const std::string& origin);

/// The same where there is such a file in a folder that may hold one of another kind and name: nothing where there is
/// none, or where it has neither key, which is said in `assumptions`.
std::optional<Calibration> find_calibration(const std::filesystem::path& folder, std::vector<std::string>& assumptions);

/// The text of such a file.
std::string calibration_text(const Calibration& calibration);

}  // namespace dynamic_icp::datasets
