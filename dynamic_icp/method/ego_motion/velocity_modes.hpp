// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/ego_motion/doppler_fit.hpp"

namespace dynamic_icp::ego_motion {

/// A velocity that many rows agree on.
struct VelocityMode {
  Vector7d x = Vector7d::Zero();
  double inlier_weight = 0.0;  ///< share of the support, in [0, 1]
};

/// How modes are looked for.
struct ModeSearch {
  std::size_t hypotheses = 256;
  std::size_t max_modes = 6;
  double width_mps = 0.35;          ///< a row within this residual agrees, the more the smaller it is
  double within_mps = 0.0;          ///< hypotheses come from rows with smaller residuals at the start; 0: all
  double acceleration_sigma = 0.0;  ///< m/s^2: widens the vote of rows away from the reference time
  std::uint64_t seed = 0;
};

/// The modes of the support near or far from `start`, best first: hypotheses are exact for three rows, drawn so that
/// their lines of sight spread; they have a and b of `start`. `start` itself is one. Hypotheses that predict almost
/// the same Doppler as a better one are left out. Always at least one mode; the same for any number of threads.
std::vector<VelocityMode> find_modes(const ConsensusSet& consensus_set, const Vector7d& start, const ModeSearch& search,
                                     const Workers& workers);

/// Share of the support for x: weighted mean of max(0, 1 - (e/width)^2).
double inlier_weight(const ConsensusSet& consensus_set, const Vector7d& x, double width_mps);

/// How different states look to the sensor, whatever its field of view.
class StateDistance {
 public:
  explicit StateDistance(const DopplerRows& rows);

  /// Root mean square over the rows of the difference between the Doppler that two states predict, m/s.
  double operator()(const Vector7d& a, const Vector7d& b) const;

 private:
  Matrix7d gram_ = Matrix7d::Zero();  ///< mean of J J^T over the rows, J = [u; dt u; -1]
};

}  // namespace dynamic_icp::ego_motion
