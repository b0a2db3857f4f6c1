// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/ego_motion/doppler_rows.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kEnoughCells = 300;
constexpr int kMostHalvings = 6;

// Edge of a direction sector on the unit cube, three to six degrees. What errs together,
// the surfaces of one object, falls into one sector or a few.
constexpr double kSectorEdge = 0.1;

/// Numbers keys in the order in which they first appear; open addressing in one array.
class KeyNumbers {
 public:
  explicit KeyNumbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1)) {}

  std::uint32_t number_of(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::uint64_t hash = (key ^ (key >> 31)) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29;
    std::size_t slot = hash & mask;
    while (slots_[slot].number != kNone && slots_[slot].key != key) {
      slot = (slot + 1) & mask;
    }
    if (slots_[slot].number == kNone) {
      slots_[slot] = {key, count_++};
    }
    return slots_[slot].number;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = kNone;
  };
  std::vector<Slot> slots_;
  std::uint32_t count_ = 0;
};

/// Three cube coordinates of 21 bits each. What lies beyond 2^20 cells shares the outermost one.
std::uint64_t cell_key(const Eigen::Vector3d& point, double per_cell) {
  constexpr double kMost = (1 << 20) - 1;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::clamp(std::floor(point[axis] * per_cell), -kMost, kMost);
    key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + (1 << 20));
  }
  return key;
}

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

struct CellNumbers {
  std::vector<std::uint32_t> of_point;
  std::size_t count = 0;
};

CellNumbers number_cells(const Scan& scan, double cell_size_m) {
  KeyNumbers numbers(scan.size());
  CellNumbers cells;
  cells.of_point.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    cells.of_point[i] = numbers.number_of(cell_key(scan.points()[i], 1.0 / cell_size_m));
  }
  cells.count = numbers.count();
  return cells;
}

void number_sectors(DopplerRows& rows) {
  KeyNumbers numbers(rows.sector.size());
  for (std::size_t c = 0; c < rows.sector.size(); ++c) {
    rows.sector[c] = numbers.number_of(sector_key(rows.u[rows.first[c]]));
  }
  rows.sectors = numbers.count();
}

}  // namespace

DopplerRows sort_into_cells(const Scan& scan, double cell_size_m) {
  CellNumbers cells = number_cells(scan, cell_size_m);
  for (int halving = 0; halving < kMostHalvings && cells.count < std::min(kEnoughCells, scan.size() / 4); ++halving) {
    cell_size_m *= 0.5;
    cells = number_cells(scan, cell_size_m);
  }
  DopplerRows rows;
  rows.first.assign(cells.count + 1, 0);
  for (const std::uint32_t cell : cells.of_point) {
    ++rows.first[cell + 1];
  }
  for (std::size_t c = 0; c < cells.count; ++c) {
    rows.first[c + 1] += rows.first[c];
  }
  if (scan.has_times() && !scan.empty()) {
    const auto [earliest, latest] = std::ranges::minmax(scan.times());
    rows.reference_time_s = 0.5 * (earliest + latest);
    rows.duration_s = latest - earliest;
    rows.takes_time = latest > earliest;
  }
  rows.u.resize(scan.size());
  rows.s.resize(scan.size());
  rows.dt.assign(scan.size(), 0.0);
  std::vector<std::uint32_t> next(rows.first.begin(), rows.first.end());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::uint32_t row = next[cells.of_point[i]]++;
    rows.u[row] = scan.directions()[i];
    rows.s[row] = scan.doppler()[i];
    rows.dt[row] = rows.takes_time ? scan.times()[i] - rows.reference_time_s : 0.0;
  }
  rows.range.assign(cells.count, 0.0);
  for (std::size_t i = scan.size(); i-- > 0;) {
    rows.range[cells.of_point[i]] = scan.points()[i].norm();
  }
  rows.sector.resize(cells.count);
  number_sectors(rows);
  return rows;
}

Electorate elect(const DopplerRows& rows, std::size_t most) {
  const std::size_t n = std::min(most, rows.cells());
  Electorate electorate;
  DopplerRows& chosen = electorate.rows;
  chosen.reference_time_s = rows.reference_time_s;
  chosen.duration_s = rows.duration_s;
  chosen.takes_time = rows.takes_time;
  chosen.sectors = rows.sectors;
  chosen.first.push_back(0);
  std::vector<std::size_t> farthest(rows.sectors, n);
  std::size_t occupied = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t cell = k * rows.cells() / n;
    const std::size_t row = (rows.first[cell] + rows.first[cell + 1]) / 2;
    chosen.u.push_back(rows.u[row]);
    chosen.s.push_back(rows.s[row]);
    chosen.dt.push_back(rows.dt[row]);
    chosen.sector.push_back(rows.sector[cell]);
    chosen.range.push_back(rows.range[cell]);
    chosen.first.push_back(static_cast<std::uint32_t>(k + 1));
    std::size_t& outermost = farthest[rows.sector[cell]];
    occupied += outermost == n ? 1 : 0;
    outermost = outermost == n || rows.range[cell] > chosen.range[outermost] ? k : outermost;
  }
  electorate.weights.assign(n, 0.5 / static_cast<double>(std::max<std::size_t>(n, 1)));
  for (const std::size_t k : farthest) {
    if (k < n) {
      electorate.weights[k] += 0.5 / static_cast<double>(occupied);
    }
  }
  return electorate;
}

}  // namespace dynamic_icp::ego_motion
