// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

// The unknowns x = [v; a; b] of the Doppler of one scan: velocity of the sensor (m/s) at the reference time, its change
// during the scan (m/s^2) and a constant error of the Doppler (m/s). A static point at time dt after the reference
// shows s = -u . (v + a dt) + b; its residual is e = s + u . (v + a dt) - b.

/// e of row i.
inline double residual(const DopplerRows& rows, std::size_t i, const Vector7d& x) {
  return rows.s[i] + rows.u(i).dot(x.head<3>() + rows.dt[i] * x.segment<3>(3)) - x[6];
}

/// How far residuals count.
struct RobustScale {
  double noise_mps = 0.1;   ///< standard deviation of the Doppler of one static point
  double cutoff_mps = 0.4;  ///< beyond it a point has no weight (Tukey)
  double surface_mps =
      0.0;  ///< standard deviation of what the points of one cell have in common; 0: cells are not judged
};

/// Weighted sums over the rows, in units of the noise: H = sum w J J^T / noise^2 with J = de/dx, and so on.
struct FitSums {
  Matrix7d H = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();  ///< sum w e J / noise^2
  double weights = 0.0;                  ///< sum w
  double slopes = 0.0;                   ///< sum psi'(e): what a weight is worth when the residual changes
  double inlier_squared = 0.0;           ///< sum e^2 over the inliers, (m/s)^2
  std::size_t inliers = 0;               ///< rows with weight

  FitSums& operator+=(const FitSums& other);
};

/// Widens the scale by a step, up to `max_noise_mps`, where residuals are still dense at the cutoff, so that their pull
/// falls as they grow: neighbours that err together, as where the Doppler has coarse steps, make the noise look small.
/// Returns whether it did.
bool widen_if_too_narrow(const FitSums& sums, double max_noise_mps, RobustScale& scale);

/// The sums at x. If `cell_gradients` is given it receives the part of each cell in the gradient. Cells of more than
/// a thousand points are judged in parts.
FitSums sum_fit(const DopplerRows& rows, const Vector7d& x, const RobustScale& scale, const Workers& workers,
                std::vector<Vector7d>* cell_gradients = nullptr);

}  // namespace dynamic_icp::ego_motion
