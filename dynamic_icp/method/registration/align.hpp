// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/registration/align_config.hpp"
#include "dynamic_icp/method/registration/alignment.hpp"
#include "dynamic_icp/method/registration/correspondences.hpp"
#include "dynamic_icp/method/registration/gauss_newton.hpp"
#include "dynamic_icp/method/registration/objective.hpp"

namespace dynamic_icp::registration {

/// The paper's objective with the weights and scales of a configuration.
Objective dynamic_icp_objective(const AlignConfig& config);

/// The stopping rule: fitness and inlier RMSE both change by less than the tolerance.
StopRule stop_rule(const MatchingConfig& config);

/// Aligns two scans: each iteration pairs every source point with its nearest target point and makes a Gauss-Newton
/// step of the objective. The result is the same bits for any number of threads. Throws std::invalid_argument where
/// normals are missing or the objective is impossible.
Alignment align(const Source& source, const Target& target, const Eigen::Isometry3d& T_initial,
                const Objective& objective, const StopRule& stop, const Workers& workers);

/// Doppler-aware ICP matching of the paper, Eq. (12)-(14): minimises
///   sum (1 - lambda_v) rho_g(r_g) + lambda_v rho_v(r_v)
/// over T_target_source by iteratively reweighted Gauss-Newton with Tukey weights. The source must have been predicted
/// to the time of the target (dynamics/prediction).
Alignment align(const Scan& source, const Target& target, const Eigen::Isometry3d& T_initial, const AlignConfig& config,
                const Workers& workers);

}  // namespace dynamic_icp::registration
