// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp::preprocess {

struct VoxelGridConfig {
  double voxel_size_m = 0.3;  ///< 0 keeps every point
};

ConfigFields fields(VoxelGridConfig& config);

/// One row per occupied cubic voxel: the first in scan order, whole and as measured. Averaging a voxel would mix the
/// Doppler of a moving edge with that of the wall behind it into a velocity nobody measured.
///
/// A point p lies in the voxel floor(p / voxel_size_m), also below zero. Rows stay in scan order. Coordinates must be
/// below 2^20 voxels in magnitude (300 km at 0.3 m); throws std::invalid_argument otherwise.
Scan voxel_grid(const Scan& scan, const VoxelGridConfig& config);
Scan voxel_grid(const Scan& scan, const VoxelGridConfig& config, const Workers& workers);

/// Working memory of `voxel_rows`, to be used again for the next scan.
struct VoxelMemory {
  std::vector<std::uint64_t> keys;  ///< of each point
  spatial::KeyNumbers voxels;
};

/// Puts the rows that `voxel_grid` keeps into `kept`, ascending.
void voxel_rows(const Scan& scan, const VoxelGridConfig& config, const Workers& workers, VoxelMemory& memory,
                std::vector<std::uint32_t>& kept);

}  // namespace dynamic_icp::preprocess
