// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/base/scan.hpp"
#include "dynamic_icp/base/se3.hpp"
#include "dynamic_icp/estimation/normal_equations.hpp"
#include "dynamic_icp/registration/correspondences.hpp"

namespace dynamic_icp::registration {

struct AlignConfig {
  double doppler_weight = 0.2;     ///< lambda_v; 0 leaves the Doppler term out (ablation "w/o DR")
  double tukey_geometry_m = 0.5;   ///< rho_g
  double tukey_doppler_mps = 0.3;  ///< rho_v
  double max_correspondence_distance_m = 0.3;
  int max_iterations = 100;
  double tolerance = 1e-5;  ///< on the change of fitness and of inlier RMSE (m)
  int min_correspondences = 6;
  double rank_tolerance = 1e-12;
};

ConfigFields fields(AlignConfig& config);

enum class AlignStatus {
  kNotRun,
  kConverged,
  kIterationLimit,
  kTooFewCorrespondences,
  kDegenerate,  ///< some directions are not constrained at all: see Alignment::degenerate
};

std::string_view to_string(AlignStatus status);

/// How one term of the objective fits at the final pose.
struct TermStatistics {
  std::size_t count = 0;    ///< residuals
  std::size_t inliers = 0;  ///< those with a weight above zero
  double rms = 0.0;         ///< of the inliers, in the unit of the term: m or m/s
};

/// The result of an alignment.
struct Alignment {
  AlignStatus status = AlignStatus::kNotRun;
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  int iterations = 0;
  double fitness = 0.0;      ///< share of the source points with a correspondence
  double inlier_rmse = 0.0;  ///< m, of the distances of the correspondences
  std::size_t correspondences = 0;
  TermStatistics geometry;         ///< point to plane, m
  TermStatistics doppler;          ///< rotation-only Doppler, m/s; count 0 when the term is off
  double information_ratio = 0.0;  ///< least over best constrained direction, of the scaled normal equations
  std::vector<estimation::DegenerateDirection> degenerate;  ///< empty unless the status says so
  /// Of the left perturbation [omega (rad); rho (m)] in the target frame; absent when it cannot be stated. It is
  /// H^-1 (sum w^2 r^2 J J^T) H^-1 over the residuals of this pair, so it needs no noise model, but it takes the
  /// residuals as independent and the correspondences as right: it is a lower bound.
  std::optional<Matrix6d> covariance;
};

/// Doppler-aware ICP matching of the paper, Eq. (12)-(14): minimises
///   sum (1 - lambda_v) rho_g(r_g) + lambda_v rho_v(r_v)
/// over T_target_source by iteratively reweighted Gauss-Newton with Tukey weights. Each iteration pairs every source
/// point with its nearest target point. It stops when fitness and inlier RMSE both change by less than the tolerance.
///
/// The source must have been predicted to the time of the target (dynamics/prediction). The result is the same bits
/// for any number of threads.
Alignment align(const Scan& source, const Target& target, const Eigen::Isometry3d& T_initial, const AlignConfig& config,
                const Workers& workers);

}  // namespace dynamic_icp::registration
