// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/method/spatial/cell_key.hpp"
#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kEnoughCells = 300;
constexpr int kMaxHalvings = 6;

// Edge of a direction sector on the unit cube, three to six degrees. What errs together,
// the surfaces of one object, falls into one sector or a few.
constexpr double kSectorEdge = 0.1;

/// The face of the cube around the sensor that a direction leaves through, and where on it.
std::uint64_t sector_key(const Eigen::Vector3d& u) {
  int axis = 0;
  const double largest = u.cwiseAbs().maxCoeff(&axis);
  std::uint64_t key = static_cast<std::uint64_t>(2 * axis + (u[axis] > 0.0 ? 1 : 0));
  for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) {
    key = key << 8 | static_cast<std::uint64_t>((u[other] / largest + 1.0) / kSectorEdge);
  }
  return key;
}

/// Finds out where each point goes.
void place_in_cells(const Scan& scan, double cell_size_m, const Workers& workers, spatial::CellOrder& order) {
  order.keys.resize(scan.size());
  const double per_cell = 1.0 / cell_size_m;
  workers.for_each(scan.size(), kPointBlock,
                   [&](std::size_t i) { order.keys[i] = spatial::clamped_cell_key(per_cell * scan.points()[i]); });
  order.sort();
}

void number_sectors(DopplerRows& rows) {
  spatial::KeyNumbers numbers;
  for (std::size_t c = 0; c < rows.sector.size(); ++c) {
    rows.sector[c] = numbers.number_of(sector_key(rows.u(rows.first[c])));
  }
  rows.sectors = numbers.count();
}

/// The times of a scan, as they count for its rows.
void measure_time(const Scan& scan, DopplerRows& rows) {
  rows.reference_time_s = 0.0;
  rows.duration_s = 0.0;
  rows.takes_time = false;
  if (scan.has_times() && !scan.empty()) {
    const auto [earliest, latest] = std::ranges::minmax(scan.times());
    rows.reference_time_s = 0.5 * (earliest + latest);
    rows.duration_s = latest - earliest;
    rows.takes_time = latest > earliest;
  }
}

}  // namespace

DopplerRows sort_into_cells(const Scan& scan, double cell_size_m, const Workers& workers) {
  spatial::CellOrder order;
  DopplerRows rows;
  sort_into_cells(scan, cell_size_m, workers, order, rows);
  return rows;
}

void sort_into_cells(const Scan& scan, double cell_size_m, const Workers& workers, spatial::CellOrder& order,
                     DopplerRows& rows) {
  place_in_cells(scan, cell_size_m, workers, order);
  for (int halving = 0; halving < kMaxHalvings && order.cells() < std::min(kEnoughCells, scan.size() / 4); ++halving) {
    cell_size_m *= 0.5;
    place_in_cells(scan, cell_size_m, workers, order);
  }
  rows.first = order.first;
  measure_time(scan, rows);
  for (std::vector<double>* column : {&rows.ux, &rows.uy, &rows.uz, &rows.s, &rows.dt}) {
    column->resize(scan.size());
  }
  rows.range.resize(order.cells());
  rows.key.resize(order.cells());
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const std::uint32_t row = order.place(i);
    rows.ux[row] = scan.directions()[i].x();
    rows.uy[row] = scan.directions()[i].y();
    rows.uz[row] = scan.directions()[i].z();
    rows.s[row] = scan.doppler()[i];
    rows.dt[row] = rows.takes_time ? scan.times()[i] - rows.reference_time_s : 0.0;
    if (order.rank[i] == 0) {
      rows.range[order.cell[i]] = scan.points()[i].norm();
      rows.key[order.cell[i]] = order.keys[i];
    }
  });
  rows.sector.resize(order.cells());
  number_sectors(rows);
}

void without_rows(const DopplerRows& rows, spatial::CellOrder& order, std::span<const std::uint8_t> flags,
                  DopplerRows& kept) {
  order.count_items([&](std::size_t i) { return flags[i] != 0; });
  kept.reference_time_s = rows.reference_time_s;
  kept.duration_s = rows.duration_s;
  kept.takes_time = rows.takes_time;
  kept.first.assign(1, 0);
  constexpr std::array kColumns = {&DopplerRows::ux, &DopplerRows::uy, &DopplerRows::uz, &DopplerRows::s,
                                   &DopplerRows::dt};
  for (const auto column : kColumns) {
    (kept.*column).clear();
  }
  kept.range.clear();
  kept.key.clear();
  kept.on_support.clear();
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    if (order.counted_most_of(cell)) {
      continue;
    }
    const std::uint32_t begin = rows.first[cell];
    const std::uint32_t end = rows.first[cell + 1];
    for (const auto column : kColumns) {
      (kept.*column).insert((kept.*column).end(), (rows.*column).begin() + begin, (rows.*column).begin() + end);
    }
    kept.first.push_back(static_cast<std::uint32_t>(kept.s.size()));
    kept.range.push_back(rows.range[cell]);
    kept.key.push_back(rows.key[cell]);
    if (!rows.on_support.empty()) {
      kept.on_support.push_back(rows.on_support[cell]);
    }
  }
  kept.sector.resize(kept.range.size());
  number_sectors(kept);
}

ConsensusSet sample(const DopplerRows& rows, std::size_t most) {
  const std::size_t n = std::min(most, rows.cells());
  ConsensusSet consensus_set;
  DopplerRows& chosen = consensus_set.rows;
  chosen.reference_time_s = rows.reference_time_s;
  chosen.duration_s = rows.duration_s;
  chosen.takes_time = rows.takes_time;
  chosen.sectors = rows.sectors;
  chosen.first.push_back(0);
  std::vector<std::size_t> farthest(rows.sectors, n);
  std::size_t occupied = 0;
  std::vector<std::size_t> on_support;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t cell = k * rows.cells() / n;
    const std::size_t row = (rows.first[cell] + rows.first[cell + 1]) / 2;
    chosen.ux.push_back(rows.ux[row]);
    chosen.uy.push_back(rows.uy[row]);
    chosen.uz.push_back(rows.uz[row]);
    chosen.s.push_back(rows.s[row]);
    chosen.dt.push_back(rows.dt[row]);
    chosen.sector.push_back(rows.sector[cell]);
    chosen.range.push_back(rows.range[cell]);
    chosen.first.push_back(static_cast<std::uint32_t>(k + 1));
    if (!rows.on_support.empty() && rows.on_support[cell] != 0) {
      on_support.push_back(k);
    }
    std::size_t& outermost = farthest[rows.sector[cell]];
    occupied += outermost == n ? 1 : 0;
    outermost = outermost == n || rows.range[cell] > chosen.range[outermost] ? k : outermost;
  }
  const double share = on_support.empty() ? 0.5 : 1.0 / 3.0;
  consensus_set.weights.assign(n, share / static_cast<double>(std::max<std::size_t>(n, 1)));
  for (const std::size_t k : farthest) {
    if (k < n) {
      consensus_set.weights[k] += share / static_cast<double>(occupied);
    }
  }
  for (const std::size_t k : on_support) {
    consensus_set.weights[k] += share / static_cast<double>(on_support.size());
  }
  return consensus_set;
}

}  // namespace dynamic_icp::ego_motion
