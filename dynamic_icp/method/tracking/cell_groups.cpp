// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/cell_groups.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kTighter = 0.8;     // links are shortened by this factor ...
constexpr int kMostTightenings = 2;  // ... so often; much shorter ones than a cell would part everything

/// The groups that some of the cells make among themselves.
std::vector<CellGroup> groups_among(const MovingCells& moving, std::span<const std::uint32_t> cells,
                                    const GroupingConfig& config) {
  std::vector<MovingCell> chosen;
  for (const std::uint32_t cell : cells) {
    chosen.push_back(moving.cells[cell]);
  }
  const std::vector<std::uint32_t> numbers = group_cells(chosen, config);
  std::vector<CellGroup> groups;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (numbers[i] == groups.size()) {
      groups.emplace_back();
    }
    groups[numbers[i]].cells.push_back(cells[i]);
  }
  return groups;
}

/// Whether seen from above the cells need a wider strip than one vehicle.
bool too_wide(const MovingCells& moving, const CellGroup& group, double largest_width_m) {
  constexpr int kDirections = 12;
  double width = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const Vector3d across = upright_axes(std::numbers::pi * i / kDirections).col(1);
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t cell : group.cells) {
      low = std::min(low, across.dot(moving.cells[cell].centroid));
      high = std::max(high, across.dot(moving.cells[cell].centroid));
    }
    width = std::min(width, high - low);
  }
  return width > largest_width_m;
}

/// Gives each group its rows.
void add_rows(const MovingCells& moving, std::vector<CellGroup>& groups) {
  constexpr std::uint32_t kNoGroup = ~0u;
  std::vector<std::uint32_t> group_of_cell(moving.cells.size(), kNoGroup);
  for (std::uint32_t i = 0; i < groups.size(); ++i) {
    for (const std::uint32_t cell : groups[i].cells) {
      group_of_cell[cell] = i;
    }
  }
  for (std::size_t i = 0; i < moving.rows.size(); ++i) {
    const std::uint32_t group = group_of_cell[moving.cell_of[i]];
    if (group != kNoGroup) {
      groups[group].rows.push_back(moving.rows[i]);
    }
  }
}

}  // namespace

std::vector<CellGroup> vehicle_groups(const MovingCells& moving, std::span<const std::uint32_t> cells,
                                      double largest_width_m, int min_points, const GroupingConfig& config) {
  GroupingConfig tighter = config;
  std::vector<CellGroup> groups = groups_among(moving, cells, config);
  for (int i = 0; i < kMostTightenings; ++i) {
    tighter.link_distance_m *= kTighter;
    tighter.link_growth *= kTighter;
    std::vector<CellGroup> parted;
    for (CellGroup& group : groups) {
      if (too_wide(moving, group, largest_width_m)) {
        std::vector<CellGroup> parts = groups_among(moving, group.cells, tighter);
        std::move(parts.begin(), parts.end(), std::back_inserter(parted));
      } else {
        parted.push_back(std::move(group));
      }
    }
    groups = std::move(parted);
  }
  add_rows(moving, groups);
  std::erase_if(groups, [&](const CellGroup& group) { return std::cmp_less(group.rows.size(), min_points); });
  return groups;
}

}  // namespace dynamic_icp::tracking
