// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/patch_scatter.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::mapping {
namespace {

constexpr double kMedianOfChiSquared = 0.4549;
constexpr double kMinVariance_m2 = 1e-12;  // of points without any noise: a micrometre
constexpr double kMax_m = 1.0;
constexpr int kHalvings = 16;  // of a metre: to 0.02 mm

double median_ratio(std::span<const PatchMean> patches, double deviation_m) {
  std::vector<double> ratios;
  ratios.reserve(patches.size());
  for (const PatchMean& patch : patches) {
    ratios.push_back(patch.squared_mean / (patch.explained + deviation_m * deviation_m + kMinVariance_m2));
  }
  return median(std::move(ratios));
}

}  // namespace

double unexplained_sigma(std::span<const PatchMean> patches) {
  if (patches.empty() || median_ratio(patches, 0.0) <= kMedianOfChiSquared) {
    return 0.0;
  }
  double low = 0.0;
  double high = kMax_m;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (median_ratio(patches, middle) > kMedianOfChiSquared ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace dynamic_icp::mapping
