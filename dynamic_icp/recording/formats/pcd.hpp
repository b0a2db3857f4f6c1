// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <Eigen/Core>

#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::formats {

/// The bytes of a PCD file, version 0.7, binary: per point little-endian float32 x, y, z (m). No points make a valid
/// file of width 0. Throws as `point_table` does.
std::string pcd_bytes(std::span<const Eigen::Vector3d> points);

/// The same of any columns, each with the type it has, bit by bit: arrays of shape (N,) or (N, k), at least one.
/// Numbers that are not finite stay. Throws as `checked_rows` does.
std::string pcd_table_bytes(std::span<const NamedArray> columns);

/// Writes a file of points whole or not at all (see write_whole_file). Throws as `pcd_bytes` does, and DataError naming
/// file and reason when the machine fails.
void write_pcd(const std::filesystem::path& path, std::span<const Eigen::Vector3d> points);

}  // namespace dynamic_icp::formats
