// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace dynamic_icp::preprocess {

/// The direction in which points scatter least, and how much they do in the next one.
struct LeastScatter {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit eigenvector of the smallest eigenvalue, either sign
  double middle = 0.0;                                   ///< the middle eigenvalue, in the unit of the matrix
};

/// Of a symmetric matrix without negative eigenvalues. As accurate as the iteration of Eigen's solver: the direction
/// deviates by some rounding errors times largest eigenvalue over the gap between the smallest two. Where they are
/// nearly one, or the matrix is nearly a line's, that iteration itself takes over.
LeastScatter least_scatter(const Eigen::Matrix3d& scatter);

}  // namespace dynamic_icp::preprocess
