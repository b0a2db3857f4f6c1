// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/doppler_sums.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

/// What is known of the unknowns x = [v; a; b] (see doppler_sums.hpp) beside the rows.
struct DopplerModel {
  Vector7d prior = Vector7d::Zero();
  Matrix7d information = Matrix7d::Zero();  ///< inverse covariance of the prior; definite in a and b
};

/// One step of Gauss and Newton with the priors of the model.
struct FitStep {
  Vector7d step = Vector7d::Zero();
  Eigen::Matrix3d open = Eigen::Matrix3d::Zero();  ///< projector onto the directions of v that are not observed
};

/// Solves for the step from x. A direction of v whose standard deviation, given everything else unknown too, would
/// exceed `unobservable_sigma_mps` is not observed: no step is made along it.
FitStep solve_fit(const FitSums& sums, const Vector7d& x, const DopplerModel& model, double unobservable_sigma_mps);

/// Covariance of the gradient of x, from its parts summed over the direction sectors: residuals within a sector may
/// depend on each other in any way. Few sectors say little about their own scatter, none at all when they fit exactly:
/// the scatter expected from independent noise, H, counts like as many sectors as three times the unknowns.
Matrix7d gradient_scatter(const DopplerRows& rows, const Matrix7d& H, const std::vector<Vector7d>& cell_gradients);

/// Covariance of x by the sandwich formula, from gradients summed over the direction sectors: residuals within a
/// sector may depend on each other in any way. Zero along the directions of v that `open` projects onto. See the source
/// for small samples.
Matrix7d sandwich_covariance(const DopplerRows& rows, const FitSums& sums, const Eigen::Matrix3d& open,
                             const DopplerModel& model, const std::vector<Vector7d>& cell_gradients);

/// (m/s)^2 that the covariance of a velocity never falls below: 1 mm/s, and for a sweep of `duration_s` the change of
/// velocity that a constant acceleration leaves out.
double floor_variance(double duration_s);

/// Deviation of the Doppler of single points, from differences between neighbours within a cell. They belong to the
/// same surface, so moving ones count like static ones and no crowd widens it. Falls back on the residuals themselves
/// where cells hold single points. Zero rows give `maximum`; the result is within the two bounds.
double noise_from_neighbours(const DopplerRows& rows, const Vector7d& x, double minimum_mps, double maximum_mps);

}  // namespace dynamic_icp::ego_motion
