// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/estimation/normal_equations.hpp"

// How well the motion between two scans is known.
namespace dynamic_icp::motion {

/// The directions [omega * length_m; rho] (m) along which a motion is known worse than `deviation_m`, worst first; with
/// their share of the information of the best known direction.
std::vector<estimation::DegenerateDirection> unobservable_directions(const Matrix6d& covariance, double length_m,
                                                                     double deviation_m);

/// Least over best known direction of a motion, as a ratio of their information.
double information_ratio(const Matrix6d& covariance, double length_m);

}  // namespace dynamic_icp::motion
