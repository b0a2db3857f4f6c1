// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/creeping_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::ego_motion {
namespace {

// What surfaces differ by even where the sensor has no error, m/s.
constexpr double kSurface_mps = 0.015;

}  // namespace

std::vector<std::uint8_t> creeping_cells(const DopplerRows& rows, const EgoVelocity& ego, double noise_mps,
                                         double sigmas) {
  const std::size_t cells = rows.cells();
  std::vector<double> mean(cells);
  std::vector<double> variance(cells);
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> farthest;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    double sum = 0.0;
    for (std::size_t row = rows.first[cell]; row < rows.first[cell + 1]; ++row) {
      sum += rows.s[row] + rows.u(row).dot(ego.velocity_sensor + rows.dt[row] * ego.acceleration_sensor) - ego.bias_mps;
    }
    const auto count = static_cast<double>(rows.first[cell + 1] - rows.first[cell]);
    mean[cell] = std::abs(sum / count);
    variance[cell] = noise_mps * noise_mps / count;
    const std::size_t sector = rows.sector[cell];
    if (sector >= farthest.size()) {
      farthest.resize(sector + 1, kNone);
    }
    if (farthest[sector] == kNone || rows.range[cell] > rows.range[farthest[sector]]) {
      farthest[sector] = cell;
    }
  }
  std::vector<double> far_means;
  std::vector<double> far_variances;
  for (const std::size_t cell : farthest) {
    if (cell != kNone) {
      far_means.push_back(mean[cell]);
      far_variances.push_back(variance[cell]);
    }
  }
  std::vector<std::uint8_t> creeps(cells, 0);
  if (far_means.empty()) {
    return creeps;
  }
  const double scatter = kSigmaPerMad * median(far_means);
  const double off = std::max(kSurface_mps * kSurface_mps, scatter * scatter - median(far_variances));
  for (std::size_t cell = 0; cell < cells; ++cell) {
    creeps[cell] = mean[cell] > sigmas * std::sqrt(off + variance[cell]) ? 1 : 0;
  }
  return creeps;
}

}  // namespace dynamic_icp::ego_motion
