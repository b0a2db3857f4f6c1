// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::datasets {

/// Poses T_world_sensor of a file, in its order.
struct PoseFile {
  formats::Trajectory poses;  ///< at least one; stamps strictly increasing where there are any, else all 0
  bool has_stamps = true;
  std::size_t repeated_lines = 0;  ///< left out because they say the same as the line before
};

/// Reads poses in any of these layouts, told by the first lines:
///   TUM    8 columns: timestamp tx ty tz qx qy qz qw (formats/tum.hpp)
///   KITTI  12 columns: the 3x4 matrix of a pose, row by row. Stamps are in a times.txt beside the file, seconds, one a
///          line; without it, or where it has another count, there are none
///   text with a header of names, in any order: a time (timestamp, time, t, stamp, ...: seconds, or whole numbers whose
///          size tells the unit of Unix time, or of the unit that the name ends in, such as _ns), a position (x or tx
///          or px, ...) and a unit quaternion (qx, qy, qz, qw, ...); EuRoC's is one
/// Throws DataError naming file, line and what was expected.
PoseFile read_pose_file(const std::filesystem::path& path);

/// The same as a ground truth of scans at these stamps: poses without stamps take those of the scans, one for one.
/// Throws DataError where their numbers differ.
formats::Trajectory read_truth(const std::filesystem::path& path, const std::vector<Stamp>& scans);

/// When the scans of a recording are, or the poses of a trajectory.
std::vector<Stamp> stamps_of(const Dataset& dataset);
std::vector<Stamp> stamps_of(const formats::Trajectory& trajectory);

}  // namespace dynamic_icp::datasets
