// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"

#include <algorithm>

namespace dynamic_icp::motion {
namespace {

/// The covariance of [omega * length_m; rho], all in metres.
Matrix6d in_metres(const Matrix6d& covariance, double length_m) {
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(length_m);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

std::vector<estimation::DegenerateDirection> unobservable_directions(const Matrix6d& covariance, double length_m,
                                                                     double deviation_m) {
  const auto [values, vectors] = estimation::symmetric_eigen(in_metres(covariance, length_m));
  std::vector<estimation::DegenerateDirection> unknown;
  for (int k = 5; k >= 0 && values[k] > deviation_m * deviation_m; --k) {
    unknown.push_back({vectors.col(k), std::max(0.0, values[0]) / values[k]});
  }
  return unknown;
}

double information_ratio(const Matrix6d& covariance, double length_m) {
  const Vector6d values = estimation::symmetric_eigen(in_metres(covariance, length_m)).values;
  return values[5] > 0.0 ? std::max(0.0, values[0]) / values[5] : 0.0;
}

}  // namespace dynamic_icp::motion
