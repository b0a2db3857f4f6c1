// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/registration/align.hpp"

namespace dynamic_icp::registration {

/// The objective around one pose: normal equations, and how the terms fit.
struct Linearisation {
  estimation::NormalEquations equations;
  Matrix6d score = Matrix6d::Zero();  ///< sum (w r)^2 J J^T: the spread of the gradient, for the covariance
  TermStatistics geometry;            ///< rms still holds the sum of squares of the inliers while parts are added
  TermStatistics doppler;
};

/// Sums weights, residuals and Jacobians of both terms over the correspondences at T_target_source.
Linearisation linearise(const Scan& source, const Target& target, const Correspondences& correspondences,
                        const Eigen::Isometry3d& T_target_source, const AlignConfig& config, const Workers& workers);

/// The value of the objective, Eq. (14), for fixed correspondences.
double cost(const Scan& source, const Target& target, const Correspondences& correspondences,
            const Eigen::Isometry3d& T_target_source, const AlignConfig& config);

}  // namespace dynamic_icp::registration
