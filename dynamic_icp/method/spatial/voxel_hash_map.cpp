// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/voxel_hash_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::spatial {
namespace {

constexpr double kMaxCell = 1 << 30;
constexpr std::uint32_t kNone = KeyNumbers::kNone;

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
    : voxel_size_m_(voxel_size_m), capacity_(static_cast<std::uint32_t>(max_points_per_voxel)) {
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
    const std::size_t row = voxels_.number_of(*cell);
    if (row == counts_.size()) {
      counts_.push_back(0);
      points_.resize(points_.size() + capacity_);
    }
    if (counts_[row] < capacity_) {
      points_[row * capacity_ + counts_[row]] = point;
      ++counts_[row];
    }
  }
}

void VoxelHashMap::remove_far(const Eigen::Vector3d& position, double max_distance_m) {
  const double gate = squared_gate(max_distance_m);
  std::size_t kept = 0;
  for (std::size_t row = 0; row < counts_.size(); ++row) {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(row * capacity_);
    if (squared_distance(*first, position) > gate) {
      continue;
    }
    if (kept != row) {
      std::copy_n(first, counts_[row], points_.begin() + static_cast<std::ptrdiff_t>(kept * capacity_));
      counts_[kept] = counts_[row];
    }
    ++kept;
  }
  if (kept != counts_.size()) {
    counts_.resize(kept);
    points_.resize(kept * capacity_);
    number_voxels();
  }
}

/// By the first point of each.
void VoxelHashMap::number_voxels() {
  voxels_.clear();
  for (std::size_t row = 0; row < counts_.size(); ++row) {
    voxels_.number_of(*cell_of(points_[row * capacity_]));
  }
}

std::optional<Neighbour> VoxelHashMap::nearest(const Eigen::Vector3d& query, double max_distance_m) const {
  const std::optional<Cell> centre = cell_of(query);
  if (!centre) {
    return std::nullopt;
  }
  Neighbour best{kNone, squared_gate(max_distance_m)};
  for (const auto& step : kSteps) {
    const Cell cell = {(*centre)[0] + step[0], (*centre)[1] + step[1], (*centre)[2] + step[2]};
    if (squared_gap(query, cell) > best.squared_distance) {
      continue;
    }
    const std::uint32_t row = voxels_.find(cell);
    if (row == kNone) {
      continue;
    }
    const std::uint32_t begin = row * capacity_;
    for (std::uint32_t index = begin; index < begin + counts_[row]; ++index) {
      const Neighbour candidate{index, squared_distance(points_[index], query)};
      if (is_nearer(candidate, best)) {
        best = candidate;
      }
    }
  }
  return best.index == kNone ? std::nullopt : std::optional(best);
}

std::vector<Eigen::Vector3d> VoxelHashMap::points() const {
  std::vector<Eigen::Vector3d> all;
  all.reserve(size());
  for (std::size_t row = 0; row < counts_.size(); ++row) {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(row * capacity_);
    all.insert(all.end(), first, first + counts_[row]);
  }
  return all;
}

std::size_t VoxelHashMap::size() const { return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0}); }

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

void VoxelHashMap::state(StateArchive& archive) {
  archive(counts_);
  archive.require(std::ranges::all_of(counts_, [&](std::uint32_t count) { return count >= 1 && count <= capacity_; }) &&
                      counts_.size() < kNone / capacity_,
                  "the size of a voxel");
  points_.resize(counts_.size() * capacity_);
  for (std::size_t row = 0; row < counts_.size(); ++row) {
    for (std::uint32_t i = 0; i < counts_[row]; ++i) {
      archive(points_[row * capacity_ + i]);
    }
    archive.require(cell_of(points_[row * capacity_]).has_value(), "a point of a voxel");
  }
  if (archive.reads()) {
    number_voxels();
    archive.require(voxels_.count() == counts_.size(), "a voxel");
  }
}

}  // namespace dynamic_icp::spatial
