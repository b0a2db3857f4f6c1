// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/principal_motions.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace dynamic_icp::window {
namespace {

constexpr double kContradiction = 11.07;  // 95 % of chi-squared with five degrees of freedom
constexpr double kLost = 0.1;             // of the information about a motion: with less, no matter where it points
constexpr int kHalvings = 6;              // of the weight of the past

/// By how much the information of a scan in these motions exceeds what the noise of its normals explains, at most.
double contradiction(const PrincipalMotions& with_past, const PrincipalMotions& of_scan, double patches,
                     double max_noise_share) {
  Vector6d found = with_past.noise_shares;
  Vector6d most = of_scan.noise_shares;
  std::sort(found.begin(), found.end());
  std::sort(most.begin(), most.end());
  double worst = 0.0;
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (most[k] > kLost * max_noise_share) {
      worst = std::max(worst, patches * (1.0 / found[k] - 1.0 / most[k]));
    }
  }
  return worst;
}

}  // namespace

PrincipalMotions principal_motions(const MotionInformation& scan) {
  const Eigen::LLT<Matrix6d> root(scan.all);
  const Matrix6d whiten = root.matrixL().solve(Matrix6d::Identity());
  const estimation::SymmetricEigen shares = estimation::symmetric_eigen(whiten * scan.noise * whiten.transpose());
  return {root.matrixU().solve(shares.vectors), shares.values};
}

ContinuedMotions continue_motions(const MotionInformation& scan, const MotionInformation& past, double patches,
                                  double max_noise_share) {
  const PrincipalMotions of_scan = principal_motions(scan);
  ContinuedMotions result{of_scan, scan};
  const auto agrees = [&](double weight) {
    const MotionInformation sums = {scan.all + weight * past.all, scan.noise + weight * past.noise};
    PrincipalMotions of_sums = principal_motions(sums);
    PrincipalMotions in_scan = of_sums;
    for (Eigen::Index k = 0; k < 6; ++k) {
      auto motion = of_sums.motions.col(k);
      motion /= std::sqrt(motion.dot(scan.all * motion));
      in_scan.noise_shares[k] = motion.dot(scan.noise * motion);
    }
    if (contradiction(in_scan, of_scan, patches, max_noise_share) > kContradiction) {
      return false;
    }
    of_sums.noise_shares = of_sums.noise_shares.cwiseMax(in_scan.noise_shares);
    result = {of_sums, sums};
    return true;
  };
  if (agrees(1.0)) {
    return result;
  }
  double agreed = 0.0;
  double step = 0.5;
  for (int k = 0; k < kHalvings; ++k, step *= 0.5) {
    if (agrees(agreed + step)) {
      agreed += step;
    }
  }
  return result;
}

}  // namespace dynamic_icp::window
