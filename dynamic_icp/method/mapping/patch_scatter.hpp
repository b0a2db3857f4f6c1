// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace dynamic_icp::mapping {

/// How far the points on one patch of the map lie from its plane on average.
struct PatchMean {
  double squared_mean = 0.0;  ///< m^2
  double explained = 0.0;  ///< m^2, variance of the mean by the noise of the points and the error of the fitted plane
};

/// The standard deviation (m) that all patches have beyond what explains them: the d for which the median of
/// squared_mean / (explained + d^2) is that of a chi-squared variable with one degree of freedom. The median, because
/// some patches hold moving things or two surfaces. Zero where everything is explained, or without patches.
double unexplained_sigma(std::span<const PatchMean> patches);

}  // namespace dynamic_icp::mapping
