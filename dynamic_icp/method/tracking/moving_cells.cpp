// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/moving_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/spatial/cell_order.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kWiderThanReach = 1.001;  // rounding must not put cells within reach two cubes apart

void add_point(const Scan& scan, std::uint32_t row, MovingCell& cell) {
  cell.centroid += scan.points()[row];
  cell.direction += scan.directions()[row];
  cell.time_s += scan.has_times() ? scan.times()[row] : 0.0;
  ++cell.count;
}

constexpr std::size_t kCellBlock = 64;  // cells a worker takes at once
constexpr std::size_t kAhead = 16;      // moving points lie far apart in memory: what comes is asked for in time

void prefetch_point(const Scan& scan, std::uint32_t row) {
  __builtin_prefetch(&scan.points()[row]);
  __builtin_prefetch(&scan.directions()[row]);
}

/// The rows that move, ascending.
void find_moving_rows(std::span<const std::uint8_t> is_moving, const Workers& workers, MovingCells& result) {
  std::vector<std::uint32_t>& end_of_block = result.end_of_block;
  end_of_block.resize(Workers::block_count(is_moving.size(), kPointBlock));
  workers.for_blocks(is_moving.size(), kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    end_of_block[block] = static_cast<std::uint32_t>(count_flagged(is_moving, begin, end));
  });
  std::partial_sum(end_of_block.begin(), end_of_block.end(), end_of_block.begin());
  const std::size_t rows = end_of_block.empty() ? 0 : end_of_block.back();
  make_room(result.rows, rows);
  result.rows.resize(rows);
  workers.for_blocks(is_moving.size(), kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::uint32_t next = block == 0 ? 0 : end_of_block[block - 1];
    visit_flagged(is_moving, begin, end,
                  [&](std::size_t row) { result.rows[next++] = static_cast<std::uint32_t>(row); });
  });
}

/// From sums to means.
void take_means(MovingCell& cell) {
  const auto count = static_cast<double>(cell.count);
  cell.centroid /= count;
  cell.direction /= count;
  cell.time_s /= count;
}

/// Whether a cell may lie beside the gap where the radial velocity of its body passes zero.
bool beside_gap(const MovingCell& cell, const GroupingConfig& config) {
  return std::abs(cell.radial_mps) <= config.bridge_velocity_mps;
}

/// Whether two cells of this squared distance are neighbours on one body.
bool linked(const NearCell& a, const NearCell& b, double squared, const GroupingConfig& config) {
  const bool gap = a.radial_mps * b.radial_mps < 0.0 && a.beside_gap && b.beside_gap;
  const double link = config.link_distance_m + config.link_growth * std::min(a.range_m, b.range_m);
  const double longest = gap ? std::max(link, config.bridge_m) : link;
  return squared <= longest * longest &&
         std::abs(a.radial_mps - b.radial_mps) <= config.link_velocity_mps + config.link_shear_rps * std::sqrt(squared);
}

/// The cube itself and 13 of its 26 neighbours, so that each pair of cubes comes up once: differences of keys.
constexpr std::array<std::uint64_t, 14> kHalfNeighbourhood = [] {
  std::array<std::uint64_t, 14> offsets{};
  std::size_t count = 0;
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) {
      for (std::int64_t z = -1; z <= 1; ++z) {
        const std::int64_t offset =
            x * (std::int64_t{1} << 2 * spatial::kCellBits) + y * (std::int64_t{1} << spatial::kCellBits) + z;
        if (offset >= 0) {
          offsets[count++] = static_cast<std::uint64_t>(offset);
        }
      }
    }
  }
  return offsets;
}();

/// Sorts `memory.near` into cubes of this edge.
void sort_into_cubes(double cube_m, GroupingMemory& memory) {
  spatial::CellOrder& cubes = memory.cubes;
  cubes.keys.clear();
  for (const NearCell& cell : memory.near) {
    cubes.keys.push_back(spatial::clamped_cell_key(cell.centroid / cube_m));
  }
  cubes.sort();
  make_room(memory.keys, cubes.cells());
  make_room(memory.sorted, memory.near.size());
  memory.keys.resize(cubes.cells());
  memory.sorted.resize(memory.near.size());
  for (std::size_t k = 0; k < memory.sorted.size(); ++k) {
    memory.keys[cubes.cell[k]] = cubes.keys[k];
    memory.sorted[cubes.place(k)] = memory.near[k];
  }
}

/// Unites the sets of each two of `memory.near` that are neighbours on one body and at most `reach_m` apart. Most of
/// what is in a cube is one set soon, and two such cubes need no more than one pair of neighbours.
void unite_neighbours(double reach_m, const GroupingConfig& config, GroupingMemory& memory) {
  const double cube_m = kWiderThanReach * reach_m;
  const double squared_reach = cube_m * cube_m;
  sort_into_cubes(cube_m, memory);
  const spatial::CellOrder& cubes = memory.cubes;
  const std::vector<NearCell>& sorted = memory.sorted;  // side by side in memory if they are in space
  spatial::DisjointSets& sets = memory.sets;
  const auto unite = [&](const NearCell& a, const NearCell& b) {
    const double squared = (a.centroid - b.centroid).squaredNorm();
    return squared <= squared_reach && linked(a, b, squared, config) && sets.unite(a.number, b.number);
  };
  const auto set_of = [&](std::size_t cube) { return sets.find(sorted[cubes.first[cube]].number); };
  refill(memory.is_one_set, cubes.cells(), std::uint8_t{0});
  for (std::size_t cube = 0; cube < cubes.cells(); ++cube) {
    const std::uint32_t begin = cubes.first[cube];
    const std::uint32_t end = cubes.first[cube + 1];
    const auto is_one_set = [&] {
      const std::uint32_t set = set_of(cube);
      return std::all_of(sorted.begin() + begin, sorted.begin() + end,
                         [&](const NearCell& cell) { return sets.find(cell.number) == set; });
    };
    std::uint32_t united = 1;
    for (std::uint32_t a = begin; a < end && united < end - begin; ++a) {
      for (std::uint32_t b = a + 1; b < end; ++b) {
        united += unite(sorted[a], sorted[b]) ? 1 : 0;
      }
    }
    memory.is_one_set[cube] = is_one_set() ? 1 : 0;
  }
  for (std::size_t cube = 0; cube < cubes.cells(); ++cube) {
    for (const std::uint64_t offset : std::span(kHalfNeighbourhood).subspan(1)) {
      const std::uint32_t other = cubes.numbers.find(memory.keys[cube] + offset);
      if (other == spatial::KeyNumbers::kNone) {
        continue;
      }
      // Cells of the set that all of the other cube is need nothing, and others no more than one pair of neighbours.
      const bool are_swapped = memory.is_one_set[other] == 0 && memory.is_one_set[cube] != 0;
      const std::size_t from = are_swapped ? other : cube;
      const std::size_t to = are_swapped ? cube : other;
      const bool is_one_set = memory.is_one_set[to] != 0;
      const bool are_sets = is_one_set && memory.is_one_set[from] != 0;
      bool is_done = false;
      for (std::uint32_t a = cubes.first[from]; a < cubes.first[from + 1] && !(are_sets && is_done); ++a) {
        is_done = is_one_set && sets.find(sorted[a].number) == set_of(to);
        for (std::uint32_t b = cubes.first[to]; b < cubes.first[to + 1] && !is_done; ++b) {
          is_done = unite(sorted[a], sorted[b]) && is_one_set;
        }
      }
    }
  }
}

constexpr double kTighter = 0.8;    // links are shortened by this factor ...
constexpr int kMaxTightenings = 2;  // ... so often; much shorter ones than a cell would part everything

/// Adds a group to others.
void add_group(std::span<const std::uint32_t> cells, CellGroups& groups) {
  groups.cells.insert(groups.cells.end(), cells.begin(), cells.end());
  groups.first_cell.push_back(static_cast<std::uint32_t>(groups.cells.size()));
}

/// Adds the groups that some of the cells make among themselves, without those with too few points: parts of them have
/// no more.
void add_groups_among(const MovingCells& moving, std::span<const std::uint32_t> cells, int min_points,
                      const GroupingConfig& config, GroupingMemory& memory, CellGroups& groups) {
  constexpr std::uint32_t kDropped = ~0u;
  memory.chosen.clear();
  for (const std::uint32_t cell : cells) {
    memory.chosen.push_back(moving.cells[cell]);
  }
  group_cells(memory.chosen, config, memory, memory.numbers);
  memory.sizes.clear();
  memory.points.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (memory.numbers[i] == memory.sizes.size()) {
      memory.sizes.push_back(0);
      memory.points.push_back(0);
    }
    ++memory.sizes[memory.numbers[i]];
    memory.points[memory.numbers[i]] += memory.chosen[i].count;
  }
  refill(memory.places, memory.sizes.size(), kDropped);
  for (std::size_t number = 0; number < memory.sizes.size(); ++number) {
    if (!std::cmp_less(memory.points[number], min_points)) {
      memory.places[number] = groups.first_cell.back();
      groups.first_cell.push_back(groups.first_cell.back() + memory.sizes[number]);
    }
  }
  make_room(groups.cells, groups.first_cell.back());
  groups.cells.resize(groups.first_cell.back());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::uint32_t& place = memory.places[memory.numbers[i]]; place != kDropped) {
      groups.cells[place++] = cells[i];
    }
  }
}

constexpr std::size_t kDirections = 12;

/// Directions seen from above, of half a turn.
std::array<Eigen::Vector3d, kDirections> directions_across() {
  std::array<Eigen::Vector3d, kDirections> across;
  for (std::size_t i = 0; i < kDirections; ++i) {
    across[i] = upright_axes(std::numbers::pi * static_cast<double>(i) / kDirections).col(1);
  }
  return across;
}

/// Whether seen from above the cells need a wider strip than one vehicle.
bool too_wide(const MovingCells& moving, std::span<const std::uint32_t> cells, double largest_width_m) {
  static const std::array<Eigen::Vector3d, kDirections> kAcross = directions_across();
  for (const Eigen::Vector3d& across : kAcross) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t cell : cells) {
      low = std::min(low, across.dot(moving.cells[cell].centroid));
      high = std::max(high, across.dot(moving.cells[cell].centroid));
    }
    if (!(high - low > largest_width_m)) {
      return false;
    }
  }
  return true;
}

/// Gives each group its rows.
void add_rows(const MovingCells& moving, std::vector<std::uint32_t>& group_of_cell, CellGroups& groups) {
  constexpr std::uint32_t kNoGroup = ~0u;
  refill(group_of_cell, moving.cells.size(), kNoGroup);
  groups.first_row.assign(1, 0);
  for (std::uint32_t group = 0; group < groups.size(); ++group) {
    std::uint32_t rows = 0;
    for (const std::uint32_t cell : groups.cells_of(group)) {
      group_of_cell[cell] = group;
      rows += moving.cells[cell].count;
    }
    groups.first_row.push_back(groups.first_row.back() + rows);
  }
  make_room(groups.rows, groups.first_row.back());
  groups.rows.resize(groups.first_row.back());
  for (std::size_t i = 0; i < moving.rows.size(); ++i) {
    const std::uint32_t group = group_of_cell[moving.order.cell[i]];
    if (group != kNoGroup) {
      groups.rows[groups.first_row[group]++] = moving.rows[i];
    }
  }
  // Each first place has moved on to that of the next group.
  for (std::size_t group = groups.size(); group > 0; --group) {
    groups.first_row[group] = groups.first_row[group - 1];
  }
  groups.first_row[0] = 0;
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

void gather_cells(const Scan& scan, std::span<const double> radial, std::span<const std::uint8_t> is_moving,
                  const GroupingConfig& config, const Workers& workers, MovingCells& result) {
  find_moving_rows(is_moving, workers, result);
  const std::size_t n = result.rows.size();
  spatial::CellOrder& order = result.order;
  make_room(order.keys, n);
  order.keys.resize(n);
  workers.for_blocks(n, kPointBlock, [&](std::size_t /*block*/, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i + kAhead < n) {
        prefetch_point(scan, result.rows[i + kAhead]);
      }
      order.keys[i] = spatial::clamped_cell_key(scan.points()[result.rows[i]] / config.cell_size_m);
    }
  });
  order.sort();
  // In the order of the rows, which is that of the memory.
  refill(result.cells, order.cells(), MovingCell{});
  make_room(result.radial, n);
  result.radial.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kAhead < n) {
      prefetch_point(scan, result.rows[i + kAhead]);
    }
    add_point(scan, result.rows[i], result.cells[order.cell[i]]);
    result.radial[order.place(i)] = radial[result.rows[i]];
  }
  workers.for_each(order.cells(), kCellBlock, [&](std::size_t c) {
    take_means(result.cells[c]);
    result.cells[c].radial_mps = interpolated_median_among(
        std::span(result.radial).subspan(order.first[c], order.first[c + 1] - order.first[c]));
  });
}

void group_cells(std::span<const MovingCell> cells, const GroupingConfig& config, GroupingMemory& memory,
                 std::vector<std::uint32_t>& groups) {
  memory.near.clear();
  double farthest = 0.0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const double range = cells[i].centroid.norm();
    memory.near.push_back({cells[i].centroid, range, cells[i].radial_mps, i, beside_gap(cells[i], config)});
    farthest = std::max(farthest, range);
  }
  memory.sets.reset(cells.size());
  const double longest = config.link_distance_m + config.link_growth * farthest;
  unite_neighbours(std::max(longest, config.cell_size_m), config, memory);
  // Only bridges over gaps are longer.
  if (config.bridge_m > longest) {
    std::erase_if(memory.near, [](const NearCell& cell) { return !cell.beside_gap; });
    unite_neighbours(config.bridge_m, config, memory);
  }
  refill(memory.number_of_root, cells.size(), ~0u);
  make_room(groups, cells.size());
  groups.resize(cells.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    std::uint32_t& number = memory.number_of_root[memory.sets.find(i)];
    if (number == ~0u) {
      number = count++;
    }
    groups[i] = number;
  }
}

void vehicle_groups(const MovingCells& moving, std::span<const std::uint32_t> cells, double largest_width_m,
                    int min_points, const GroupingConfig& config, GroupingMemory& memory, CellGroups& groups) {
  GroupingConfig links = config;
  const auto clear = [&] {
    groups.cells.clear();
    groups.first_cell.assign(1, 0);
  };
  clear();
  add_groups_among(moving, cells, min_points, links, memory, groups);
  links.bridge_m = 0.0;  // a gap in one body, or two bodies beside each other?
  for (int i = 0; i <= kMaxTightenings; ++i) {
    if (i > 0) {
      links.link_distance_m *= kTighter;
      links.link_growth *= kTighter;
    }
    std::swap(groups, memory.wide);
    clear();
    for (std::size_t group = 0; group < memory.wide.size(); ++group) {
      const std::span<const std::uint32_t> of_group = memory.wide.cells_of(group);
      if (too_wide(moving, of_group, largest_width_m)) {
        add_groups_among(moving, of_group, min_points, links, memory, groups);
      } else {
        add_group(of_group, groups);
      }
    }
  }
  add_rows(moving, memory.group_of_cell, groups);
}

}  // namespace dynamic_icp::tracking
