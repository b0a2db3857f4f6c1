// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/support_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/ego_motion/cell_doppler.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::ego_motion {
namespace {

// Which points may be static is asked anew with the velocity that was found.
constexpr int kRounds = 2;
constexpr int kSteps = 5;

constexpr double kTukeyCutoff = 3.0;    // of the scale of the cells
constexpr double kMinScale_mps = 0.05;  // of a sensor without errors: what is farther off is no road
constexpr double kPrior_mps = 0.5;      // the surface may hardly show a direction, mostly its own
constexpr double kAcross_mps = 0.2;  // standard deviation of the velocity along the normal: whatever drives sways ...
constexpr double kNormal_rad = 0.1;  // ... and the normal is known only so well

/// The change of `velocity` that the cells ask for.
Eigen::Vector3d change_of_velocity(const std::vector<CellDoppler>& cells, const Eigen::Vector3d& velocity,
                                   const Eigen::Vector3d& normal) {
  const double across_variance = kAcross_mps * kAcross_mps + kNormal_rad * kNormal_rad * velocity.squaredNorm();
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  std::vector<double> sizes(cells.size());
  for (int step = 0; step < kSteps; ++step) {
    const auto off = [&](const CellDoppler& cell) { return cell.off_mps + cell.u.dot(change); };
    std::ranges::transform(cells, sizes.begin(), [&](const CellDoppler& cell) { return std::abs(off(cell)); });
    const double scale = std::max(kMinScale_mps, kSigmaPerMad * median(sizes));
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / (kPrior_mps * kPrior_mps);
    Eigen::Vector3d gradient = change / (kPrior_mps * kPrior_mps);
    information += normal * normal.transpose() / across_variance;
    gradient += normal.dot(velocity + change) / across_variance * normal;
    for (const CellDoppler& cell : cells) {
      const double weight = estimation::tukey_weight(off(cell), kTukeyCutoff * scale) / (scale * scale + cell.variance);
      information += weight * cell.u * cell.u.transpose();
      gradient += weight * off(cell) * cell.u;
    }
    change -= information.ldlt().solve(gradient);
  }
  return change;
}

}  // namespace

Eigen::Vector3d support_velocity(const DopplerRows& rows, const EgoVelocity& ego, const Eigen::Vector3d& normal,
                                 double noise_mps, double moving_mps) {
  EgoVelocity of_support = ego;
  const std::vector<std::size_t> cells = support_cells(rows);
  std::vector<CellDoppler> doppler(cells.size());
  if (cells.size() >= kEnoughOnSupport) {
    for (int round = 0; round < kRounds; ++round) {
      std::ranges::transform(cells, doppler.begin(), [&](std::size_t cell) {
        return doppler_of_cell(rows, cell, of_support, noise_mps, moving_mps);
      });
      of_support.velocity_sensor += change_of_velocity(doppler, of_support.velocity_sensor, normal);
    }
  }
  return of_support.velocity_sensor;
}

}  // namespace dynamic_icp::ego_motion
