// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::formats {

// Trajectories as text, one pose a line: "timestamp tx ty tz qx qy qz qw" (seconds, metres, unit quaternion). The pose
// is T_world_sensor. Columns are separated by blanks or single commas; # starts a comment.

/// What a file held.
struct TumFile {
  Trajectory trajectory;           ///< at least one pose, stamps strictly increasing
  std::size_t repeated_lines = 0;  ///< lines dropped because they say the same as the line before: worth a warning
};

/// Reads a trajectory. Stamps are decimal seconds, exact to the nanosecond; integers of 13, 16 or 19 digits, too large
/// for seconds, are Unix time in milli-, micro- or nanoseconds, as some data sets write it. Quaternions within 1e-3 of
/// unit length are normalised.
///
/// Throws DataError naming the file, the line and what was expected: unreadable or empty file, Git LFS pointer, wrong
/// number of columns, not a finite number, quaternion not of unit length, stamps that do not increase.
TumFile read_tum(const std::filesystem::path& path);

/// The same for text already in memory; `name` stands for the file in messages.
TumFile parse_tum(std::string_view text, std::string_view name);

/// Writes a trajectory whole or not at all. Stamps get nine decimals; all other numbers as many digits as it takes to
/// read back the same double. Throws DataError for what `read_tum` would not accept back (no pose, a pose that is not
/// finite or no rotation, stamps that do not increase) and when the file cannot be written.
void write_tum(const std::filesystem::path& path, const Trajectory& trajectory);

/// The text that `write_tum` writes; `name` stands for the file in messages.
std::string format_tum(const Trajectory& trajectory, std::string_view name);

/// One line of it, with its line break, for writers that append pose by pose. Throws DataError as `write_tum`.
std::string format_tum_line(const StampedPose& pose, std::string_view name);

}  // namespace dynamic_icp::formats
