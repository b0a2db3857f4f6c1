// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace dynamic_icp::spatial {
namespace {

constexpr double kMaxCell = 1 << 30;
constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kFewestSlots = 64;

std::uint64_t hash(const std::array<std::int32_t, 3>& cell) {
  std::uint64_t mixed = 0;
  for (const std::int32_t coordinate : cell) {
    mixed = (mixed ^ static_cast<std::uint32_t>(coordinate)) * 0x9e3779b97f4a7c15ULL;
    mixed ^= mixed >> 32;  // the lower bits choose the slot
  }
  return mixed;
}

/// The 27 steps from a voxel to itself and its neighbours, itself first: what it holds is likely to be nearest, and
/// most neighbours are then too far away to be looked into.
constexpr std::array<std::array<std::int32_t, 3>, 27> steps() {
  std::array<std::array<std::int32_t, 3>, 27> result{};
  std::size_t count = 0;
  for (int axes = 0; axes <= 3; ++axes) {  // axes that differ: faces before edges before corners
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x * x + y * y + z * z == axes) {
            result[count++] = {x, y, z};
          }
        }
      }
    }
  }
  return result;
}

constexpr auto kSteps = steps();

}  // namespace

VoxelHashMap::VoxelHashMap(double voxel_size_m, int max_points_per_voxel)
    : voxel_size_m_(voxel_size_m),
      capacity_(static_cast<std::uint32_t>(max_points_per_voxel)),
      slots_(kFewestSlots, kFree) {
  if (!(voxel_size_m > 0.0) || max_points_per_voxel < 1) {
    throw std::invalid_argument("a voxel needs an edge above zero and room for at least one point");
  }
}

void VoxelHashMap::add(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& point : points) {
    const std::optional<Cell> cell = cell_of(point);
    if (!cell) {
      continue;
    }
    const std::uint32_t row = voxel_at(*cell);
    Voxel& voxel = voxels_[row];
    if (voxel.count < capacity_) {
      points_[std::size_t{row} * capacity_ + voxel.count] = point;
      ++voxel.count;
    }
  }
}

void VoxelHashMap::remove_far(const Eigen::Vector3d& position, double max_distance_m) {
  const double gate = squared_gate(max_distance_m);
  std::size_t kept = 0;
  for (std::size_t row = 0; row < voxels_.size(); ++row) {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(row * capacity_);
    if (squared_distance(*first, position) > gate) {
      continue;
    }
    if (kept != row) {
      voxels_[kept] = voxels_[row];
      std::copy_n(first, voxels_[row].count, points_.begin() + static_cast<std::ptrdiff_t>(kept * capacity_));
    }
    ++kept;
  }
  if (kept != voxels_.size()) {
    voxels_.resize(kept);
    points_.resize(kept * capacity_);
    rebuild_slots(slots_.size());
  }
}

std::optional<Neighbour> VoxelHashMap::nearest(const Eigen::Vector3d& query, double max_distance_m) const {
  const std::optional<Cell> centre = cell_of(query);
  if (!centre) {
    return std::nullopt;
  }
  Neighbour best{kFree, squared_gate(max_distance_m)};
  for (const auto& step : kSteps) {
    const Cell cell = {(*centre)[0] + step[0], (*centre)[1] + step[1], (*centre)[2] + step[2]};
    if (squared_gap(query, cell) > best.squared_distance) {
      continue;
    }
    const std::uint32_t row = slots_[slot_of(cell)];
    if (row == kFree) {
      continue;
    }
    const std::uint32_t begin = row * capacity_;
    for (std::uint32_t index = begin; index < begin + voxels_[row].count; ++index) {
      const Neighbour candidate{index, squared_distance(points_[index], query)};
      if (is_nearer(candidate, best)) {
        best = candidate;
      }
    }
  }
  return best.index == kFree ? std::nullopt : std::optional(best);
}

std::vector<Eigen::Vector3d> VoxelHashMap::points() const {
  std::vector<Eigen::Vector3d> all;
  all.reserve(size());
  for (std::size_t row = 0; row < voxels_.size(); ++row) {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(row * capacity_);
    all.insert(all.end(), first, first + voxels_[row].count);
  }
  return all;
}

std::size_t VoxelHashMap::size() const {
  std::size_t sum = 0;
  for (const Voxel& voxel : voxels_) {
    sum += voxel.count;
  }
  return sum;
}

/// Nothing for a point that is not finite or too far out.
std::optional<VoxelHashMap::Cell> VoxelHashMap::cell_of(const Eigen::Vector3d& point) const {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const double coordinate = std::floor(point[axis] / voxel_size_m_);
    if (!(std::abs(coordinate) < kMaxCell)) {
      return std::nullopt;
    }
    cell[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(coordinate);
  }
  return cell;
}

/// Where the voxel stands, or where it would stand.
std::size_t VoxelHashMap::slot_of(const Cell& cell) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(cell) & mask;
  while (slots_[slot] != kFree && voxels_[slots_[slot]].cell != cell) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

/// The square of the distance from the query to the nearest place of the voxel.
double VoxelHashMap::squared_gap(const Eigen::Vector3d& query, const Cell& cell) const {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = cell[static_cast<std::size_t>(axis)] * voxel_size_m_;
    const double gap = std::max({0.0, low - query[axis], query[axis] - (low + voxel_size_m_)});
    sum += gap * gap;
  }
  return sum;
}

/// The row of the voxel, which is made when it is not there. At most half of the slots are taken.
std::uint32_t VoxelHashMap::voxel_at(const Cell& cell) {
  const std::size_t slot = slot_of(cell);
  if (slots_[slot] != kFree) {
    return slots_[slot];
  }
  const auto row = static_cast<std::uint32_t>(voxels_.size());
  slots_[slot] = row;
  voxels_.push_back({cell, 0});
  points_.resize(points_.size() + capacity_);
  if (2 * voxels_.size() > slots_.size()) {
    rebuild_slots(2 * slots_.size());
  }
  return row;
}

void VoxelHashMap::rebuild_slots(std::size_t slots) {
  slots_.assign(slots, kFree);
  for (std::uint32_t row = 0; row < voxels_.size(); ++row) {
    slots_[slot_of(voxels_[row].cell)] = row;
  }
}

}  // namespace dynamic_icp::spatial
