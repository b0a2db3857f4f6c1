// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"

namespace dynamic_icp::conversion {

/// The layouts that recordings can be converted to.
enum class Target { kDicp, kNpz, kPcd, kPly, kMcap };

/// The layout of that name: dicp, npz, pcd, ply or mcap. Throws UsageError with the known names.
Target find_target(std::string_view name);

/// Writes scans of a recording into a folder, which exists and is empty, in another layout:
///   dicp  as datasets/layouts.hpp has it, with one pose for each scan, interpolated where the truth has other stamps
///   npz   `<stamp>.npz` with points (N, 3), doppler, time_offset_ns or time_offset_s, los (N, 3) and the other columns
///   pcd   `<stamp>.pcd`, binary, with x, y, z, doppler and so on; los_x, los_y, los_z
///   ply   `<stamp>.ply`, the same
///   mcap  recording.mcap, one file with the same columns (mcap_target.hpp), the truth and the mountings
/// The stamp is in nanoseconds, with zeros in front to 19 digits; the truth is in ref_poses.txt; where the sensor or
/// the sensors of a rig sit in calibration.json (datasets/calibration.hpp). Every column has the smallest type that
/// holds all its numbers exactly, the same in all files: what came from float32 stays float32, bit by bit. The scans
/// are read twice, once to learn these types; `progress` is called after each reading.
///
/// Gives what the target cannot hold, in sentences. Throws DataError where the recording cannot be read or the machine
/// fails.
std::vector<std::string> convert(const datasets::Dataset& dataset, const datasets::ScanRange& range, Target target,
                                 const std::filesystem::path& folder, const std::function<void()>& progress = {});

/// The same as mcap into a file of another name, which appears whole or not at all.
std::vector<std::string> convert_to_mcap(const datasets::Dataset& dataset, const datasets::ScanRange& range,
                                         const std::filesystem::path& file, const std::function<void()>& progress = {});

}  // namespace dynamic_icp::conversion
