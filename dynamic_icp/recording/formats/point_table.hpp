// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/recording/formats/npy.hpp"

// Tables of points, as the writers of PCD and PLY put them into records.
namespace dynamic_icp::formats {

/// The columns x, y, z (m) as float32: 1 mm at 10 km from the origin. Throws std::invalid_argument when a number is not
/// finite as a float32: such files never leave the program.
std::vector<NamedArray> point_table(std::span<const Eigen::Vector3d> points);

/// The number of rows of a table to be written. Throws std::invalid_argument when there is no column, when they differ
/// in length, and when names are missing, taken or have blanks; `format` is named in the message.
std::size_t checked_rows(std::span<const NamedArray> columns, std::string_view format);

/// The records of a checked table: the columns of each point, one after the other, bit by bit.
void append_records(std::string& bytes, std::span<const NamedArray> columns, std::size_t rows);

}  // namespace dynamic_icp::formats
