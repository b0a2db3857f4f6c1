// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/preprocess/voxel_grid.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace dynamic_icp::preprocess {
namespace {

constexpr double kMaxCoordinate = 1 << 20;
constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

/// Three cell coordinates of 21 bits each in one word; the topmost bit stays 0, so no key equals kEmpty.
std::uint64_t voxel_key(const Eigen::Vector3d& point, double size) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(point[axis] / size);
    if (!(std::abs(cell) < kMaxCoordinate)) {
      throw std::invalid_argument("a point lies more than 2^20 voxels from the sensor; crop the range first");
    }
    key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + (1 << 20));
  }
  return key;
}

/// Spreads the bits of a key over the word (a bijection), so that neighbouring voxels fall into different slots.
std::uint64_t mix(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9e3779b97f4a7c15ULL;
  key ^= key >> 29;
  return key;
}

/// A set of keys by open addressing: nothing but one array.
class KeySet {
 public:
  explicit KeySet(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), kEmpty) {}

  /// Whether the key was not in the set before.
  bool insert(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mix(key) & mask;
    while (slots_[slot] != kEmpty && slots_[slot] != key) {
      slot = (slot + 1) & mask;
    }
    const bool is_new = slots_[slot] == kEmpty;
    slots_[slot] = key;
    return is_new;
  }

 private:
  std::vector<std::uint64_t> slots_;
};

}  // namespace

ConfigFields fields(VoxelGridConfig& config) {
  return {{"voxel_size_m", &config.voxel_size_m, 0.0, 100.0, "m",
           "edge of the voxels of which the first measured point is kept; 0 keeps every point"}};
}

Scan voxel_grid(const Scan& scan, const VoxelGridConfig& config) {
  if (config.voxel_size_m <= 0.0) {
    return scan;
  }
  KeySet occupied(scan.size());
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    if (occupied.insert(voxel_key(scan.points()[i], config.voxel_size_m))) {
      kept.push_back(i);
    }
  }
  return scan.select(kept);
}

}  // namespace dynamic_icp::preprocess
