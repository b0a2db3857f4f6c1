// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/creeping_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/ego_motion/cell_doppler.hpp"
#include "dynamic_icp/method/spatial/cell_key.hpp"

namespace dynamic_icp::ego_motion {
namespace {

// What surfaces differ by even where the sensor has no error, m/s.
constexpr double kSurface_mps = 0.015;

// What moves has any Doppler that sensors tell, up to this.
constexpr double kFastest_mps = 100.0;

// Where so many cells creep, one that is next to them and off to the same side by so many standard deviations creeps,
// too. Elsewhere it is most likely static.
constexpr double kCrowded = 0.25;
constexpr double kNeighbourSigmas = 1.0;

/// Cells that are static far more often than not: what carries the scene where that is known, or else the farthest cell
/// of each direction sector.
std::vector<std::size_t> likely_static(const DopplerRows& rows) {
  std::vector<std::size_t> cells = support_cells(rows);
  if (cells.size() >= kEnoughOnSupport) {
    return cells;
  }
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> farthest;
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    const std::size_t sector = rows.sector[cell];
    if (sector >= farthest.size()) {
      farthest.resize(sector + 1, kNone);
    }
    if (farthest[sector] == kNone || rows.range[cell] > rows.range[farthest[sector]]) {
      farthest[sector] = cell;
    }
  }
  std::erase(farthest, kNone);
  return farthest;
}

bool is_on_support(const DopplerRows& rows, std::size_t cell) {
  return !rows.on_support.empty() && rows.on_support[cell] != 0;
}

/// How likely it is that a cell which is not on the support stands, over that it moves: by what is known to move.
double odds_of_static(const DopplerRows& rows, const std::vector<CellDoppler>& doppler,
                      const std::vector<std::uint8_t>& creeps) {
  double moving = 1.0;
  double standing = 1.0;
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    if (!is_on_support(rows, cell)) {
      (creeps[cell] != 0 || doppler[cell].share < 0.5 ? moving : standing) += 1.0;
    }
  }
  return standing / moving;
}

/// So many standard deviations off a cell moves for as likely as it stands: 1 / (2 v_max) = odds N(off; 0, sigma^2).
double even_sigmas(double odds_of_static, double sigma_mps) {
  const double ratio = odds_of_static * 2.0 * kFastest_mps / (std::sqrt(2.0 * std::numbers::pi) * sigma_mps);
  return std::sqrt(2.0 * std::log(std::max(1.0, ratio)));
}

/// From cells that creep to those next to them that are off to the same side.
void spread(const DopplerRows& rows, const std::vector<double>& sigmas_off, std::vector<std::uint8_t>& creeps) {
  std::vector<std::pair<std::uint64_t, std::size_t>> by_key;
  std::vector<std::size_t> open;
  for (std::size_t cell = 0; cell < rows.key.size(); ++cell) {
    by_key.emplace_back(rows.key[cell], cell);
    if (creeps[cell] != 0) {
      open.push_back(cell);
    }
  }
  std::ranges::sort(by_key);
  const auto visit = [&](std::size_t from, std::uint64_t key) {
    const auto at = std::ranges::lower_bound(by_key, std::pair(key, std::size_t{0}));
    if (at == by_key.end() || at->first != key || creeps[at->second] != 0) {
      return;
    }
    const std::size_t cell = at->second;
    if (!is_on_support(rows, cell) && sigmas_off[cell] * (sigmas_off[from] > 0.0 ? 1.0 : -1.0) > kNeighbourSigmas) {
      creeps[cell] = 1;
      open.push_back(cell);
    }
  };
  while (!open.empty()) {
    const std::size_t from = open.back();
    open.pop_back();
    const auto at = spatial::cell_coordinates(rows.key[from]);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        for (std::int64_t z = -1; z <= 1; ++z) {
          visit(from, spatial::cell_key(at.x() + x, at.y() + y, at.z() + z));
        }
      }
    }
  }
}

}  // namespace

std::vector<std::uint8_t> creeping_cells(const DopplerRows& rows, const EgoVelocity& ego, double noise_mps,
                                         double moving_mps, double sigmas) {
  std::vector<CellDoppler> doppler(rows.cells());
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    doppler[cell] = doppler_of_cell(rows, cell, ego, noise_mps, moving_mps);
  }
  std::vector<double> static_off;
  std::vector<double> static_variances;
  for (const std::size_t cell : likely_static(rows)) {
    static_off.push_back(std::abs(doppler[cell].off_mps));
    static_variances.push_back(doppler[cell].variance);
  }
  std::vector<std::uint8_t> creeps(rows.cells(), 0);
  if (static_off.empty()) {
    return creeps;
  }
  const double scatter = kSigmaPerMad * median(static_off);
  const double off = std::max(kSurface_mps * kSurface_mps, scatter * scatter - median(static_variances));
  std::vector<double> sigmas_off(rows.cells());
  const auto sigma_of = [&](std::size_t cell) { return std::sqrt(off + doppler[cell].variance); };
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    sigmas_off[cell] = doppler[cell].off_mps / sigma_of(cell);
    creeps[cell] = std::abs(sigmas_off[cell]) > sigmas ? 1 : 0;
  }
  const double odds = odds_of_static(rows, doppler, creeps);
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    if (!is_on_support(rows, cell) && std::abs(sigmas_off[cell]) > even_sigmas(odds, sigma_of(cell))) {
      creeps[cell] = 1;
    }
  }
  if (static_cast<double>(std::ranges::count(creeps, 1)) > kCrowded * static_cast<double>(rows.cells())) {
    spread(rows, sigmas_off, creeps);
  }
  return creeps;
}

}  // namespace dynamic_icp::ego_motion
