// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::estimation {

// Robust kernels for residuals e with scale k, both in the same unit. For each kernel:
//   loss   rho(e): what is minimised, e^2/2 near zero (a function only where somebody needs its value);
//   weight w(e) = rho'(e) / e: what iteratively reweighted least squares multiplies e^2 with.
// The weight depends on e/k alone, so changing the unit of both changes nothing.

/// Huber: rho = e^2/2 for |e| <= k, k|e| - k^2/2 beyond: convex, every residual keeps some pull.
/// w = 1 for |e| <= k, k/|e| beyond.
double huber_weight(double e, double k);

/// Tukey: rho = k^2/6 (1 - (1 - (e/k)^2)^3) for |e| <= k, k^2/6 beyond: residuals beyond k have no pull at all.
double tukey_loss(double e, double k);

/// k over the standard deviation of normal errors: then 95 % as efficient as least squares.
inline constexpr double kTukeyTuning = 4.685;

/// w = (1 - (e/k)^2)^2 for |e| <= k, 0 beyond.
inline double tukey_weight(double e, double k) {
  const double inside = 1.0 - (e / k) * (e / k);
  return inside <= 0.0 ? 0.0 : inside * inside;
}

/// Geman and McClure: rho = e^2/2 k^2/(k^2 + e^2), which approaches k^2/2: far residuals have ever less pull.
/// w = (k^2/(k^2 + e^2))^2.
double geman_mcclure_weight(double e, double k);

}  // namespace dynamic_icp::estimation
