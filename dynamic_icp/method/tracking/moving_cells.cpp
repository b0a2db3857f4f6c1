// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/moving_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/spatial/cell_order.hpp"
#include "dynamic_icp/method/spatial/disjoint_sets.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr std::size_t kCellBlock = 128;
constexpr double kWiderThanReach = 1.001;  // rounding must not put cells within reach two cubes apart

void add_point(const Scan& scan, std::uint32_t row, double radial, MovingCell& cell) {
  cell.centroid += scan.points()[row];
  cell.direction += scan.directions()[row];
  cell.radial_mps += radial;
  cell.time_s += scan.has_times() ? scan.times()[row] : 0.0;
  ++cell.count;
}

/// The rows that move, ascending.
std::vector<std::uint32_t> moving_rows(std::span<const std::uint8_t> is_moving, const Workers& workers) {
  std::vector<std::uint32_t> end_of_block(Workers::block_count(is_moving.size(), kPointBlock));
  workers.for_blocks(is_moving.size(), kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    end_of_block[block] = static_cast<std::uint32_t>(std::count_if(
        is_moving.begin() + static_cast<std::ptrdiff_t>(begin), is_moving.begin() + static_cast<std::ptrdiff_t>(end),
        [](std::uint8_t moving) { return moving != 0; }));
  });
  std::partial_sum(end_of_block.begin(), end_of_block.end(), end_of_block.begin());
  std::vector<std::uint32_t> rows(end_of_block.empty() ? 0 : end_of_block.back());
  workers.for_blocks(is_moving.size(), kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::uint32_t next = block == 0 ? 0 : end_of_block[block - 1];
    for (std::size_t row = begin; row < end; ++row) {
      if (is_moving[row] != 0) {
        rows[next++] = static_cast<std::uint32_t>(row);
      }
    }
  });
  return rows;
}

/// From sums to means.
void take_means(MovingCell& cell) {
  const auto count = static_cast<double>(cell.count);
  cell.centroid /= count;
  cell.direction /= count;
  cell.radial_mps /= count;
  cell.time_s /= count;
}

/// Whether a cell may lie beside the gap where the radial velocity of its body passes zero.
bool beside_gap(const MovingCell& cell, const GroupingConfig& config) {
  return std::abs(cell.radial_mps) <= config.bridge_velocity_mps;
}

/// Whether two cells are neighbours on one body; `range` is that of the nearer one.
bool linked(const MovingCell& a, const MovingCell& b, double range, const GroupingConfig& config) {
  const bool gap = a.radial_mps * b.radial_mps < 0.0 && beside_gap(a, config) && beside_gap(b, config);
  const double link = config.link_distance_m + config.link_growth * range;
  const double longest = gap ? std::max(link, config.bridge_m) : link;
  const double squared = (a.centroid - b.centroid).squaredNorm();
  return squared <= longest * longest &&
         std::abs(a.radial_mps - b.radial_mps) <= config.link_velocity_mps + config.link_shear_rps * std::sqrt(squared);
}

/// The cube itself and 13 of its 26 neighbours, so that each pair of cubes comes up once: differences of keys.
std::vector<std::uint64_t> half_neighbourhood() {
  std::vector<std::uint64_t> offsets;
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) {
      for (std::int64_t z = -1; z <= 1; ++z) {
        const std::int64_t offset = (x << 2 * spatial::kCellBits) + (y << spatial::kCellBits) + z;
        if (offset >= 0) {
          offsets.push_back(static_cast<std::uint64_t>(offset));
        }
      }
    }
  }
  return offsets;
}

/// Calls visit(i, k) once for each pair of the chosen cells that are at most `reach_m` apart, and for some more.
template <typename Visit>
void visit_near_pairs(std::span<const MovingCell> cells, std::span<const std::uint32_t> chosen, double reach_m,
                      const Visit& visit) {
  const double cube_m = kWiderThanReach * reach_m;
  spatial::CellOrder cubes;
  cubes.keys.resize(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    cubes.keys[k] = spatial::clamped_cell_key(cells[chosen[k]].centroid / cube_m);
  }
  cubes.sort();
  std::vector<std::uint64_t> keys(cubes.cells());
  std::vector<std::uint32_t> members(chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    keys[cubes.cell[k]] = cubes.keys[k];
    members[cubes.place(k)] = chosen[k];
  }
  const std::vector<std::uint64_t> offsets = half_neighbourhood();
  for (std::size_t cube = 0; cube < cubes.cells(); ++cube) {
    for (const std::uint64_t offset : offsets) {
      const std::uint32_t other = cubes.numbers.find(keys[cube] + offset);
      if (other == spatial::KeyNumbers::kNone) {
        continue;
      }
      for (std::uint32_t a = cubes.first[cube]; a < cubes.first[cube + 1]; ++a) {
        for (std::uint32_t b = other == cube ? a + 1 : cubes.first[other]; b < cubes.first[other + 1]; ++b) {
          visit(members[a], members[b]);
        }
      }
    }
  }
}

constexpr double kTighter = 0.8;    // links are shortened by this factor ...
constexpr int kMaxTightenings = 2;  // ... so often; much shorter ones than a cell would part everything

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
    const Eigen::Vector3d across = upright_axes(std::numbers::pi * i / kDirections).col(1);
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

ConfigFields fields(GroupingConfig& config) {
  return {
      {"cell_size_m", &config.cell_size_m, 0.01, 10.0, "m", "edge of the cubes that thin moving points for grouping"},
      {"link_distance_m", &config.link_distance_m, 0.0, 100.0, "m",
       "moving cells of one object are at most link_distance + link_growth * range apart"},
      {"link_growth", &config.link_growth, 0.0, 1.0, "m/m", "growth of that distance with the range"},
      {"link_velocity_mps", &config.link_velocity_mps, 0.0, 100.0, "m/s",
       "radial velocities of neighbours on one object differ by at most link_velocity + link_shear * distance"},
      {"link_shear_rps", &config.link_shear_rps, 0.0, 100.0, "(m/s)/m", "growth of that difference with the distance"},
      {"bridge_m", &config.bridge_m, 0.0, 100.0, "m", "longest gap in an object where its radial velocity passes zero"},
      {"bridge_velocity_mps", &config.bridge_velocity_mps, 0.0, 100.0, "m/s",
       "largest radial speed of moving cells beside such a gap"},
  };
}

MovingCells gather_cells(const Scan& scan, std::span<const double> radial, std::span<const std::uint8_t> is_moving,
                         const GroupingConfig& config, const Workers& workers) {
  MovingCells result;
  result.rows = moving_rows(is_moving, workers);
  const std::size_t n = result.rows.size();
  spatial::CellOrder order;
  order.keys.resize(n);
  workers.for_each(n, kPointBlock, [&](std::size_t i) {
    order.keys[i] = spatial::clamped_cell_key(scan.points()[result.rows[i]] / config.cell_size_m);
  });
  order.sort();
  std::vector<std::uint32_t> rows_by_cell(n);
  for (std::size_t i = 0; i < n; ++i) {
    rows_by_cell[order.place(i)] = result.rows[i];
  }
  result.cells.resize(order.cells());
  workers.for_each(result.cells.size(), kCellBlock, [&](std::size_t cell) {
    for (std::uint32_t k = order.first[cell]; k < order.first[cell + 1]; ++k) {
      add_point(scan, rows_by_cell[k], radial[rows_by_cell[k]], result.cells[cell]);
    }
    take_means(result.cells[cell]);
  });
  result.cell_of = std::move(order.cell);
  return result;
}

std::vector<std::uint32_t> group_cells(std::span<const MovingCell> cells, const GroupingConfig& config) {
  std::vector<std::uint32_t> all(cells.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::uint32_t> slow;
  std::vector<double> ranges(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    ranges[i] = cells[i].centroid.norm();
    if (beside_gap(cells[i], config)) {
      slow.push_back(i);
    }
  }
  spatial::DisjointSets sets(cells.size());
  const auto link = [&](std::uint32_t i, std::uint32_t k) {
    if (linked(cells[i], cells[k], std::min(ranges[i], ranges[k]), config)) {
      sets.unite(i, k);
    }
  };
  const double farthest = cells.empty() ? 0.0 : *std::max_element(ranges.begin(), ranges.end());
  const double longest = config.link_distance_m + config.link_growth * farthest;
  visit_near_pairs(cells, all, std::max(longest, config.cell_size_m), link);
  // Only bridges over gaps are longer.
  if (config.bridge_m > longest) {
    visit_near_pairs(cells, slow, config.bridge_m, link);
  }
  std::vector<std::uint32_t> number_of_root(cells.size(), ~0u);
  std::vector<std::uint32_t> groups(cells.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    std::uint32_t& number = number_of_root[sets.find(i)];
    if (number == ~0u) {
      number = count++;
    }
    groups[i] = number;
  }
  return groups;
}

std::vector<CellGroup> vehicle_groups(const MovingCells& moving, std::span<const std::uint32_t> cells,
                                      double largest_width_m, int min_points, const GroupingConfig& config) {
  GroupingConfig tighter = config;
  std::vector<CellGroup> groups = groups_among(moving, cells, config);
  tighter.bridge_m = 0.0;  // a gap in one body, or two bodies beside each other?
  for (int i = 0; i <= kMaxTightenings; ++i) {
    if (i > 0) {
      tighter.link_distance_m *= kTighter;
      tighter.link_growth *= kTighter;
    }
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
