// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

struct ConsensusRegressionConfig {
  double cell_size_m = 2.0;            ///< edge of the cubes that vote
  int hypotheses = 256;                ///< velocities tried, each from three points
  double inlier_threshold_mps = 0.35;  ///< residuals below this agree with a hypothesis
  double tukey_cutoff = 4.0;           ///< Tukey cutoff in standard deviations of the noise
  double min_noise_mps = 0.01;         ///< bounds of the standard deviation of the Doppler of one static point,
  double max_noise_mps = 0.25;         ///< which is estimated from each scan
  double surface_noise_mps =
      0.015;                  ///< standard deviation of the error that all Doppler values of one cell have in common
  double prior_weight = 0.5;  ///< a hypothesis gains up to this share of its support by agreeing with the prior
  double ambiguity_ratio = 0.85;  ///< ambiguous: a second velocity has this share of the support of the first
  double min_support = 0.1;  ///< no velocity: the best one has a smaller share of all votes, weighed with the priors
};

ConfigFields fields(ConsensusRegressionConfig& config);

/// What is known before the scan is looked at; the defaults are for the first one.
struct EgoPrior {
  bool has_velocity = false;         ///< off: `state` says nothing of the velocity
  Vector7d mean = Vector7d::Zero();  ///< [velocity (m/s); acceleration (m/s^2); bias (m/s)] at the reference time
  Matrix7d covariance = default_covariance();

  /// Deviations of 1 m/s, 3 m/s^2 and 0.2 m/s.
  static Matrix7d default_covariance() { return Vector7d(Vector7d{{1, 1, 1, 9, 9, 9, 0.04}}).asDiagonal(); }
};

/// Whether the prior velocity may take part: one more than four sigmas from what the scan shows is wrong, not
/// informative.
bool agrees(const EgoPrior& prior, const Eigen::Vector3d& velocity);

/// The velocity of the sensor where most of the points may move.
///
/// 1. Velocities from samples of three points are voted on. Half of all votes is spread over the cells of space, half
///    over the farthest cell of each direction, or a third each and a third over the ground where it is known (see
///    `sample`), so it takes no prior and no mounting to find the static scene. Modes of the support are refined and
///    split as finely as the noise allows; one begins at the prior velocity and keeps to it along what the view hardly
///    shows. The mode with the most support wins; agreement with the prior velocity adds
///    to the votes, but never more than `prior_weight`, so a wrong prior is outvoted.
/// 2. v, acceleration a during a sweep and Doppler bias b minimise, jointly over all points near the winner,
///      sum_cells W_c sum_i rho(s_i + u_i . (v + a dt_i) - b) / sigma^2 + prior of v, a and b,
///    with Tukey's rho, sigma from differences between neighbouring points, and a weight W_c of each cell that vanishes
///    where the mean residual of the cell cannot be noise: slow objects show there before they show point by point.
/// 3. The covariance is marginal over a and b and robust to residuals that depend on each other within a direction
///    sector. It has a floor of 1 mm/s, and for sweeps of the change of velocity that a constant a leaves out.
///
/// v is taken from the prior (or zero) only along directions that the lines of sight leave open; their covariance is
/// the prior's then, or that of (30 m/s)^2. Status: kConverged; kDegenerate with open directions; kAmbiguous when two
/// modes have similar votes, when no velocity has enough votes, or when the fit leaves what any vehicle can do: the
/// velocity is the prior then and all directions are open; kTooFewPoints below three points; kIterationLimit. All
/// values are finite for finite priors. The result is the same for any number of threads.
EgoVelocity estimate_velocity(const Scan& scan, const EgoPrior& prior, const ConsensusRegressionConfig& config,
                              const Workers& workers);

/// The same for the points of a scan that are sorted into cells already.
EgoVelocity estimate_velocity(const DopplerRows& rows, const EgoPrior& prior, const ConsensusRegressionConfig& config,
                              const Workers& workers);

}  // namespace dynamic_icp::ego_motion
