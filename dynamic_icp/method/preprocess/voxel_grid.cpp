// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"

#include <numeric>
#include <stdexcept>
#include <vector>

#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp::preprocess {
ConfigFields fields(VoxelGridConfig& config) {
  return {{"voxel_size_m", &config.voxel_size_m, 0.0, 100.0, "m",
           "voxel size; the first point of each voxel is kept, 0 keeps all points"}};
}

Scan voxel_grid(const Scan& scan, const VoxelGridConfig& config) { return voxel_grid(scan, config, Workers(1)); }

Scan voxel_grid(const Scan& scan, const VoxelGridConfig& config, const Workers& workers) {
  if (config.voxel_size_m <= 0.0) {
    return scan;
  }
  VoxelMemory memory;
  std::vector<std::uint32_t> kept;
  voxel_rows(scan, config, workers, memory, kept);
  return scan.select(kept);
}

void voxel_rows(const Scan& scan, const VoxelGridConfig& config, const Workers& workers, VoxelMemory& memory,
                std::vector<std::uint32_t>& kept) {
  if (config.voxel_size_m <= 0.0) {
    kept.resize(scan.size());
    std::iota(kept.begin(), kept.end(), 0U);
    return;
  }
  std::vector<std::uint64_t>& keys = memory.keys;
  keys.resize(scan.size());
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    keys[i] = spatial::cell_key(scan.points()[i] / config.voxel_size_m);
    if (keys[i] == spatial::kNoCell) {
      throw std::invalid_argument("a point lies more than 2^20 voxels from the sensor; crop the range first");
    }
  });
  memory.voxels.clear();
  kept.clear();
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    if (memory.voxels.number_of(keys[i]) == kept.size()) {
      kept.push_back(i);
    }
  }
}

}  // namespace dynamic_icp::preprocess
