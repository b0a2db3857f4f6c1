// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::mapping {
namespace {

constexpr std::size_t kPatchBlock = 64;

// Cells that no point has met for so many times the memory hold nothing that still counts.
constexpr double kLifetimes = 2.0;

// Each coarsest cell is looked through for old parts once in so many scans.
constexpr std::size_t kTidyPeriod = 16;

// The table of the coarsest cells is made anew when it is larger than this and less than half of it is in use.
constexpr std::size_t kManyRoots = 1024;

// How far ranges err is seen on patches of so many points that the beams meet at a steep angle (|cos|), when there are
// so many of them. Any surface scatters more than the ranges do: the smoothest patches of the smoothest scan tell, and
// the estimate rises by a hundredth a scan only.
constexpr double kTellingPoints = 20.0;
constexpr double kSteep = 0.4;
constexpr std::size_t kTellingPatches = 10;
constexpr double kSmoothest = 0.1;
constexpr double kRise = 1.01;

using Coordinates = Eigen::Matrix<std::int64_t, 3, 1>;

/// Which of the eight parts of a cell holds a cell `level` levels above the finest.
std::size_t part_of(const Coordinates& finest, int level) {
  const auto bit = [&](int axis) { return static_cast<std::size_t>(finest[axis] >> level & 1); };
  return bit(0) << 2 | bit(1) << 1 | bit(2);
}

/// The cell that holds a finest cell, `level` levels above.
std::uint64_t key_above(const Coordinates& finest, int level) {
  return spatial::cell_key(finest[0] >> level, finest[1] >> level, finest[2] >> level);
}

/// The key of one of the eight parts of a cell.
std::uint64_t key_of_part(std::uint64_t key, std::size_t part) {
  const Coordinates whole = spatial::cell_coordinates(key);
  const auto half = [&](int axis, std::size_t bit) {
    return 2 * whole[axis] + static_cast<std::int64_t>(part >> bit & 1);
  };
  return spatial::cell_key(half(0, 2), half(1, 1), half(2, 0));
}

}  // namespace

PlaneMap::PlaneMap(const PlaneMapConfig& config) : config_(config) {
  if (!(config.finest_cell_m > 0.0) || config.levels < 1 || !(config.memory_scans >= 0.0)) {
    throw std::invalid_argument("a map of planes needs cells with an edge above zero and a memory of zero or more");
  }
  per_finest_cell_ = 1.0 / config.finest_cell_m;
  fade_ = config.memory_scans > 0.0 ? std::exp(-1.0 / config.memory_scans) : 0.0;
  coarsest_edge_m_ = std::ldexp(config.finest_cell_m, config.levels - 1);
}

void PlaneMap::clear() {
  scans_ = 0;
  oldest_ = 0;
  root_numbers_.clear();
  root_keys_.clear();
  roots_.clear();
  cells_.clear();
  moments_.clear();
  patches_.clear();
  free_cells_.clear();
  free_patches_.clear();
}

void PlaneMap::add(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& position, const Workers& workers,
                   std::span<const double> phases) {
  ++scans_;
  const double lifetime = std::min(static_cast<double>(scans_), kLifetimes * config_.memory_scans);
  oldest_ = scans_ - static_cast<std::uint32_t>(lifetime);
  fitting_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    add_point(points[i], phases.empty() ? 0.0 : phases[i]);
  }
  drop_cells(position);
  range_noise_.position = position;
  fit_planes(workers);
  learn_range_noise();
}

/// Adds a point to the cells of all levels around it.
void PlaneMap::add_point(const Eigen::Vector3d& point, double phase) {
  const std::uint64_t key = finest_cell(point);
  if (key == spatial::kNoCell) {
    return;
  }
  const Coordinates finest = spatial::cell_coordinates(key);
  const int levels = config_.levels;
  std::uint32_t cell = root_at(key_above(finest, levels - 1));
  double edge_m = coarsest_edge_m_;
  for (int level = levels - 1;; --level, edge_m *= 0.5) {
    touch(cell);
    const Coordinates here(finest[0] >> level, finest[1] >> level, finest[2] >> level);
    moments_[cell].add(point - edge_m * (here.cast<double>() + Eigen::Vector3d::Constant(0.5)), phase,
                       static_cast<double>(scans_));
    if (level == 0) {
      return;
    }
    const std::size_t part = part_of(finest, level - 1);
    if (cells_[cell].parts[part] == kNone) {
      const std::uint32_t made = new_cell();
      cells_[cell].parts[part] = made;
    }
    cell = cells_[cell].parts[part];
  }
}

double PlaneMap::fade_since(std::uint32_t scan) const {
  const std::uint32_t age = scans_ - scan;
  return age == 1 ? fade_ : std::pow(fade_, static_cast<double>(age));
}

/// Fades what a cell knows from earlier scans.
void PlaneMap::touch(std::uint32_t cell) {
  Cell& touched = cells_[cell];
  if (touched.last_scan != scans_) {
    moments_[cell].scale(is_old(touched) ? 0.0 : fade_since(touched.last_scan));
    touched.last_scan = scans_;
    touched.is_stale = true;
  }
}

/// Fits the planes of the coarsest cells that changed, and of the parts of those that hold none.
void PlaneMap::fit_planes(const Workers& workers) {
  for (std::size_t root = 0; root < roots_.size(); ++root) {
    if (roots_[root] != kNone && cells_[roots_[root]].is_stale) {
      fitting_.push_back({roots_[root], root_keys_[root]});
    }
  }
  double edge_m = coarsest_edge_m_;
  for (int level = config_.levels - 1; level >= 0; --level, edge_m *= 0.5) {
    fit_level(edge_m, workers);
    go_down();
  }
}

void PlaneMap::fit_level(double edge_m, const Workers& workers) {
  for (const Fitting& fitting : fitting_) {
    if (cells_[fitting.cell].patch == kNone) {
      const std::uint32_t patch = new_patch();
      cells_[fitting.cell].patch = patch;
    }
  }
  workers.for_each(fitting_.size(), kPatchBlock, [&](std::size_t i) {
    const auto [number, key] = fitting_[i];
    Cell& cell = cells_[number];
    const std::optional<Plane> plane =
        fit_plane(moments_[number], spatial::cell_centre(key, edge_m), edge_m, config_.plane, range_noise_);
    Patch& patch = patches_[cell.patch];
    if (plane) {
      patch.plane = *plane;
      patch.plane.bend = bend_of(fitting_[i], *plane, edge_m);
    } else {
      patch.plane.points = 0.0;
    }
    cell.is_stale = false;
  });
  for (const Fitting& fitting : fitting_) {
    const Plane& plane = patches_[cells_[fitting.cell].patch].plane;
    const double facing = plane.normal.dot((plane.mean - range_noise_.position).normalized());
    if (plane.points >= kTellingPoints && std::abs(facing) > kSteep) {
      range_variances_.push_back(plane.variance / (facing * facing));
    }
  }
}

/// How far the surface itself leaves the plane: the variance of the heights of the parts of its parts, without what the
/// scatter within them makes of it.
double PlaneMap::bend_of(const Fitting& fitting, const Plane& plane, double edge_m) const {
  double squares = 0.0;
  double weights = 0.0;
  int count = 0;
  const Cell& cell = cells_[fitting.cell];
  for (std::size_t i = 0; i < cell.parts.size(); ++i) {
    if (cell.parts[i] == kNone) {
      continue;
    }
    const Cell& part = cells_[cell.parts[i]];
    for (std::size_t j = 0; j < part.parts.size(); ++j) {
      if (part.parts[j] == kNone) {
        continue;
      }
      const Moments& moments = moments_[part.parts[j]];
      const std::uint64_t key = key_of_part(key_of_part(fitting.key, i), j);
      const double height = plane.distance(spatial::cell_centre(key, 0.25 * edge_m) + moments.first / moments.weight);
      const double weight = moments.weight * fade_since(cells_[part.parts[j]].last_scan);
      squares += weight * height * height;
      weights += weight;
      ++count;
    }
  }
  const int free = count - 3;  // a plane fits three of them
  if (free < 1 || weights <= count) {
    return 0.0;
  }
  const double within = std::max(0.0, weights * plane.variance - squares) / (weights - count);
  return std::max(0.0, squares - free * within) / weights;
}

/// Too low an estimate leaves a part of the tilt, too high a one tilts planes the other way.
void PlaneMap::learn_range_noise() {
  if (range_variances_.size() >= kTellingPatches) {
    const double seen = quantile(range_variances_, kSmoothest);
    const double before = range_noise_.variance;
    range_noise_.variance = before > 0.0 ? std::min(seen, kRise * before) : seen;
  }
  range_variances_.clear();
}

double PlaneMap::range_sigma_m() const { return std::sqrt(range_noise_.variance); }

/// From the cells just fitted to the parts that are now asked for, and changed since they were fitted.
void PlaneMap::go_down() {
  parts_.clear();
  for (const auto& [number, key] : fitting_) {
    Cell& cell = cells_[number];
    if (patches_[cell.patch].plane.points > 0.0) {
      continue;
    }
    free_patches_.push_back(std::exchange(cell.patch, kNone));
    for (std::size_t part = 0; part < cell.parts.size(); ++part) {
      const std::uint32_t below = cell.parts[part];
      if (below != kNone && cells_[below].is_stale) {
        parts_.push_back({below, key_of_part(key, part)});
      }
    }
  }
  std::swap(fitting_, parts_);
}

void PlaneMap::drop_cells(const Eigen::Vector3d& position) {
  const double reach2 = config_.max_range_m * config_.max_range_m;
  std::size_t living = 0;
  for (std::size_t root = 0; root < roots_.size(); ++root) {
    if (roots_[root] == kNone) {
      continue;
    }
    const bool is_far = (spatial::cell_centre(root_keys_[root], coarsest_edge_m_) - position).squaredNorm() > reach2;
    if (is_far || is_old(cells_[roots_[root]])) {
      release(std::exchange(roots_[root], kNone));
    } else {
      ++living;
      if ((root + scans_) % kTidyPeriod == 0) {
        drop_old_parts(roots_[root]);
      }
    }
  }
  if (roots_.size() > kManyRoots && 2 * living < roots_.size()) {
    renumber_roots();
  }
}

/// Gives back what no point has met for long in a cell that lives on.
void PlaneMap::drop_old_parts(std::uint32_t cell) {
  for (std::uint32_t& part : cells_[cell].parts) {
    if (part == kNone) {
      continue;
    }
    if (is_old(cells_[part])) {
      release(std::exchange(part, kNone));
    } else {
      drop_old_parts(part);
    }
  }
}

/// Gives a cell and all its parts back.
void PlaneMap::release(std::uint32_t cell) {
  for (const std::uint32_t part : cells_[cell].parts) {
    if (part != kNone) {
      release(part);
    }
  }
  if (cells_[cell].patch != kNone) {
    free_patches_.push_back(cells_[cell].patch);
  }
  free_cells_.push_back(cell);
}

/// Forgets the coarsest cells that were dropped.
void PlaneMap::renumber_roots() {
  root_numbers_.clear();
  std::size_t kept = 0;
  for (std::size_t root = 0; root < roots_.size(); ++root) {
    if (roots_[root] != kNone) {
      root_numbers_.number_of(root_keys_[root]);
      root_keys_[kept] = root_keys_[root];
      roots_[kept] = roots_[root];
      ++kept;
    }
  }
  root_keys_.resize(kept);
  roots_.resize(kept);
}

const Patch* PlaneMap::find(std::uint64_t finest_cell) const {
  if (finest_cell == spatial::kNoCell) {
    return nullptr;
  }
  const Coordinates finest = spatial::cell_coordinates(finest_cell);
  int level = config_.levels - 1;
  const std::uint32_t root = root_numbers_.find(key_above(finest, level));
  std::uint32_t number = root == spatial::KeyNumbers::kNone ? kNone : roots_[root];
  while (number != kNone && !is_old(cells_[number])) {
    const Cell& cell = cells_[number];
    if (cell.patch != kNone) {
      return &patches_[cell.patch];
    }
    if (level == 0) {
      return nullptr;
    }
    number = cell.parts[part_of(finest, --level)];
  }
  return nullptr;  // a cell that is empty has nothing in its parts either
}

/// One of the coarsest cells, which is made when it is not there.
std::uint32_t PlaneMap::root_at(std::uint64_t key) {
  const std::uint32_t number = root_numbers_.number_of(key);
  if (number == roots_.size()) {
    roots_.push_back(kNone);
    root_keys_.push_back(key);
  }
  if (roots_[number] == kNone) {
    roots_[number] = new_cell();
  }
  return roots_[number];
}

std::uint32_t PlaneMap::new_cell() {
  auto number = static_cast<std::uint32_t>(cells_.size());
  if (free_cells_.empty()) {
    cells_.emplace_back();
    moments_.emplace_back();
  } else {
    number = free_cells_.back();
    free_cells_.pop_back();
  }
  cells_[number] = {};
  cells_[number].parts.fill(kNone);
  moments_[number] = {};
  return number;
}

std::uint32_t PlaneMap::new_patch() {
  if (!free_patches_.empty()) {
    const std::uint32_t number = free_patches_.back();
    free_patches_.pop_back();
    return number;
  }
  const auto number = static_cast<std::uint32_t>(patches_.size());
  patches_.emplace_back().id = number;
  return number;
}

}  // namespace dynamic_icp::mapping
