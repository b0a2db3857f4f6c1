// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/recording/formats/npy.hpp"

// Tables of points as PCD and PLY files: arrays of shape (N,) or (N, k), at least one, each with the type it has, bit
// by bit; numbers that are not finite stay. No points make a valid file without records. Throws std::invalid_argument
// when there is no column, when they differ in length, and when names are missing, taken or have blanks.
namespace dynamic_icp::formats {

/// The columns x, y, z (m) as float32: 1 mm at 10 km from the origin. Throws std::invalid_argument when a number is not
/// finite as a float32: such files never leave the program.
std::vector<NamedArray> point_table(std::span<const Eigen::Vector3d> points);

/// The bytes of a PCD file, version 0.7, binary.
std::string pcd_bytes(std::span<const NamedArray> columns);

/// The bytes of a PLY 1.0 file, binary_little_endian: the element "vertex". Throws std::invalid_argument also for
/// columns of several numbers a point and for integers of 64 bits, which PLY does not know.
std::string ply_bytes(std::span<const NamedArray> columns);

}  // namespace dynamic_icp::formats
