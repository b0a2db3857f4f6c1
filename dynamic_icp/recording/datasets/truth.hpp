// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::datasets {

/// Ground truth and the file it came from; both empty without.
struct Truth {
  formats::Trajectory poses;
  std::filesystem::path file;
};

/// Poses with large coordinates (UTM, ENU: more than 10 km) moved so that the first lies at the origin, in double;
/// others as they are. The axes stay.
formats::Trajectory near_origin(formats::Trajectory poses);

/// For layouts that say where their ground truth is (truth_search.hpp is for those that do not): the truth in the first
/// of the files, in the order given, that speaks of the time of the scans; files that are missing ("") are passed over.
/// Of those that exist but speak of another time, and of lines left out because they repeat, a sentence is added to
/// `assumptions`. Rows are of the sensor itself, and need not be one per scan. Throws DataError naming file and line
/// where one cannot be read (formats::read_tum).
Truth named_truth(std::span<const std::filesystem::path> files, const std::vector<Stamp>& stamps,
                  std::vector<std::string>& assumptions);

/// The transform that row-major numbers of a 3x4 or 4x4 matrix say. `place` is what messages begin with. Throws
/// DataError for another count, numbers that are not finite and what is no rotation within 1e-3.
Eigen::Isometry3d rigid_transform(std::span<const double> numbers, const std::string& place);

/// The numbers of a line, between blanks and commas. Throws DataError that begins with `place` for anything else.
std::vector<double> numbers_in(std::string_view line, const std::string& place);

}  // namespace dynamic_icp::datasets
