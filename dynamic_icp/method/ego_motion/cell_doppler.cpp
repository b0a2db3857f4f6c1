// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/cell_doppler.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::ego_motion {

CellDoppler doppler_of_cell(const DopplerRows& rows, std::size_t cell, const EgoVelocity& ego, double noise_mps,
                            double moving_mps) {
  CellDoppler result;
  double count = 0.0;
  for (std::size_t row = rows.first[cell]; row < rows.first[cell + 1]; ++row) {
    const Eigen::Vector3d velocity = ego.velocity_sensor + rows.dt[row] * ego.acceleration_sensor;
    const double off = rows.s[row] + rows.u(row).dot(velocity) - ego.bias_mps;
    if (std::abs(off) < moving_mps) {
      result.u += rows.u(row);
      result.off_mps += off;
      count += 1.0;
    }
  }
  result.share = count / std::max(1.0, static_cast<double>(rows.first[cell + 1] - rows.first[cell]));
  count = std::max(1.0, count);
  result.u /= count;
  result.off_mps /= count;
  result.variance = noise_mps * noise_mps / count;
  return result;
}

std::vector<std::size_t> support_cells(const DopplerRows& rows) {
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < rows.on_support.size(); ++cell) {
    if (rows.on_support[cell] != 0) {
      cells.push_back(cell);
    }
  }
  return cells;
}

}  // namespace dynamic_icp::ego_motion
