// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/robust_kernel.hpp"

#include <cmath>

namespace dynamic_icp::estimation {

double huber_weight(double e, double k) {
  const double size = std::abs(e);
  return size <= k ? 1.0 : k / size;
}

double tukey_loss(double e, double k) {
  const double inside = 1.0 - (e / k) * (e / k);
  const double full = k * k / 6.0;
  return inside <= 0.0 ? full : full * (1.0 - inside * inside * inside);
}

double geman_mcclure_weight(double e, double k) {
  const double ratio = e / k;
  const double share = 1.0 / (1.0 + ratio * ratio);
  return share * share;
}

}  // namespace dynamic_icp::estimation
