// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/mapping/plane_map.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace dynamic_icp::mapping {
namespace {

constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kNoCell = ~std::uint64_t{0};
constexpr std::size_t kFewestSlots = 1024;
constexpr std::size_t kBlock = 64;
constexpr std::int64_t kHalf = 1 << 20;
constexpr int kBits = 21;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

// Cells that no point has met for so many times the memory hold nothing that still counts.
constexpr double kLifetimes = 2.0;

/// Three cell coordinates in one word, or kNoCell for a point out of reach.
std::uint64_t key_of(const Eigen::Vector3d& point, double edge_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(point[axis] / edge_m);
    if (!(std::abs(cell) < static_cast<double>(kHalf))) {
      return kNoCell;
    }
    key = key << kBits | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + kHalf);
  }
  return key;
}

Eigen::Vector3d centre_of(std::uint64_t key, double edge_m) {
  Eigen::Vector3d centre;
  for (int axis = 2; axis >= 0; --axis) {
    centre[axis] = (static_cast<double>(static_cast<std::int64_t>(key & kMask) - kHalf) + 0.5) * edge_m;
    key >>= kBits;
  }
  return centre;
}

/// Spreads neighbouring cells over the slots.
std::uint64_t mix(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9e3779b97f4a7c15ULL;
  key ^= key >> 29;
  return key;
}

}  // namespace

ConfigFields fields(PlaneMapConfig& config) {
  ConfigFields all = {
      {"finest_cell_m", &config.finest_cell_m, 0.05, 10.0, "m",
       "edge of the smallest cells of the local map; each level above has twice the edge"},
      {"levels", &config.levels, 1, 6, "", "sizes of cells; the largest whose points lie in a plane is used"},
      {"memory_scans", &config.memory_scans, 0.0, 1e6, "",
       "after about so many scans a point counts 1/e; 0 keeps the last scan only"},
      {"max_range_m", &config.max_range_m, 1.0, 1e4, "m", "cells of the local map farther from the sensor are dropped"},
  };
  append_fields(all, "plane", fields(config.plane));
  return all;
}

PlaneMap::PlaneMap(const PlaneMapConfig& config) : config_(config) {
  if (!(config.finest_cell_m > 0.0) || config.levels < 1 || !(config.memory_scans >= 0.0)) {
    throw std::invalid_argument("a map of planes needs cells with an edge above zero and a memory of zero or more");
  }
  levels_.resize(static_cast<std::size_t>(config.levels));
  double edge_m = config.finest_cell_m;
  for (std::size_t k = levels_.size(); k-- > 0; edge_m *= 2.0) {
    levels_[k].edge_m = edge_m;
  }
  clear();
}

void PlaneMap::clear() {
  for (Level& level : levels_) {
    level.cells.clear();
    level.touched.clear();
    level.slots.assign(kFewestSlots, kFree);
  }
  scans_ = 0;
  patch_limit_ = 0;
}

void PlaneMap::add(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& position, const Workers& workers) {
  ++scans_;
  patch_limit_ = 0;
  for (Level& level : levels_) {
    add_points(level, points);
    fit_planes(level, workers);
    drop_cells(level, position);
    for (Cell& cell : level.cells) {
      cell.patch.id = patch_limit_++;
    }
  }
}

void PlaneMap::add_points(Level& level, std::span<const Eigen::Vector3d> points) const {
  const double fade = config_.memory_scans > 0.0 ? std::exp(-1.0 / config_.memory_scans) : 0.0;
  for (const Eigen::Vector3d& point : points) {
    const std::uint64_t key = key_of(point, level.edge_m);
    if (key == kNoCell) {
      continue;
    }
    const std::uint32_t row = level.cell_at(key);
    Cell& cell = level.cells[row];
    if (cell.last_scan != scans_) {
      cell.moments.scale(std::pow(fade, static_cast<double>(scans_ - cell.last_scan)));
      cell.last_scan = scans_;
      level.touched.push_back(row);
    }
    cell.moments.add(point - centre_of(key, level.edge_m));
  }
}

void PlaneMap::fit_planes(Level& level, const Workers& workers) const {
  workers.for_each(level.touched.size(), kBlock, [&](std::size_t i) {
    Cell& cell = level.cells[level.touched[i]];
    const std::optional<Plane> plane =
        fit_plane(cell.moments, centre_of(cell.key, level.edge_m), level.edge_m, config_.plane);
    cell.is_plane = plane.has_value();
    if (plane) {
      cell.patch.plane = *plane;
    }
  });
  level.touched.clear();
}

void PlaneMap::drop_cells(Level& level, const Eigen::Vector3d& position) const {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < level.cells.size(); ++row) {
    const Cell& cell = level.cells[row];
    const bool is_old = static_cast<double>(scans_ - cell.last_scan) > kLifetimes * config_.memory_scans;
    if (is_old || (centre_of(cell.key, level.edge_m) - position).norm() > config_.max_range_m) {
      continue;
    }
    if (kept != row) {
      level.cells[kept] = cell;
    }
    ++kept;
  }
  if (kept != level.cells.size()) {
    level.cells.resize(kept);
    level.rebuild(level.slots.size());
  }
}

const Patch* PlaneMap::find(const Eigen::Vector3d& point) const {
  for (const Level& level : levels_) {
    const std::uint64_t key = key_of(point, level.edge_m);
    const std::uint32_t row = key == kNoCell ? kFree : level.slots[level.slot_of(key)];
    if (row == kFree) {
      return nullptr;  // a cell that is empty has nothing in its parts either
    }
    if (level.cells[row].is_plane) {
      return &level.cells[row].patch;
    }
  }
  return nullptr;
}

/// Where the cell stands, or where it would stand.
std::size_t PlaneMap::Level::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots.size() - 1;
  std::size_t slot = mix(key) & mask;
  while (slots[slot] != kFree && cells[slots[slot]].key != key) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

/// The row of the cell, which is made when it is not there. At most half of the slots are taken.
std::uint32_t PlaneMap::Level::cell_at(std::uint64_t key) {
  const std::size_t slot = slot_of(key);
  if (slots[slot] != kFree) {
    return slots[slot];
  }
  const auto row = static_cast<std::uint32_t>(cells.size());
  slots[slot] = row;
  cells.emplace_back().key = key;
  if (2 * cells.size() > slots.size()) {
    rebuild(2 * slots.size());
  }
  return row;
}

void PlaneMap::Level::rebuild(std::size_t slot_count) {
  slots.assign(slot_count, kFree);
  for (std::uint32_t row = 0; row < cells.size(); ++row) {
    slots[slot_of(cells[row].key)] = row;
  }
}

}  // namespace dynamic_icp::mapping
