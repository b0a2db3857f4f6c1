// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::formats {

/// A number more for every point, beside x, y, z.
struct PcdColumn {
  std::string_view name;          ///< e.g. "doppler"; no blanks
  std::span<const float> values;  ///< one per point
};

/// The bytes of a PCD file, version 0.7, binary: per point little-endian float32 x, y, z (m), then the columns in the
/// order given. Points keep the precision of a float32: 1 mm at 10 km from the origin. No points make a valid file of
/// width 0.
///
/// Throws std::invalid_argument when a column is not as long as the points, has no name, a name with blanks or one that
/// is taken, and when a number is not finite as a float32: such files never leave the program.
std::string pcd_bytes(std::span<const Eigen::Vector3d> points, std::span<const PcdColumn> columns = {});

/// The same of any columns, each with the type it has, bit by bit: arrays of shape (N,) or (N, k), at least one.
/// Numbers that are not finite stay. Throws std::invalid_argument when they differ in length or names are missing,
/// taken or have blanks.
std::string pcd_table_bytes(std::span<const NamedArray> columns);

/// Writes a file of points whole or not at all (see write_whole_file). Throws as `pcd_bytes` does, and DataError naming
/// file and reason when the machine fails.
void write_pcd(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points,
               std::span<const PcdColumn> columns = {});

}  // namespace dynamic_icp::formats
