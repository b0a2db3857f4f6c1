// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::window {

/// What is known beforehand of the variance q of one unknown x ~ N(0, q) that may well be zero. Below `scale` all q are
/// as likely, above it those of standard deviation s by scale / s: an error that is not there costs nothing, and a
/// large one is found. MacKay's fixed point would take what no data know for zero.
struct VariancePrior {
  double scale = 1.0;      ///< standard deviation
  double min_sigma = 0.1;  ///< q is between the squares of these
  double max_sigma = 10.0;
};

/// An unknown as it was estimated with x ~ N(0, prior_variance).
struct ScalarEstimate {
  double value = 0.0;
  double variance = 0.0;  ///< less than prior_variance, as far as data know it
  double prior_variance = 1.0;
};

/// exp E[log q] with the data of the estimate; its prior does not count.
double posterior_variance(const VariancePrior& prior, const ScalarEstimate& estimate);

}  // namespace dynamic_icp::window
