// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/patch_scatter.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::mapping {
namespace {

std::vector<PatchMean> patches(double deviation_m, double outlier_share) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<PatchMean> result;
  for (int k = 0; k < 4000; ++k) {
    PatchMean patch;
    patch.explained = std::pow(0.0005 + 0.003 * uniform(random), 2);
    const double sigma =
        uniform(random) < outlier_share ? 0.05 : std::sqrt(patch.explained + deviation_m * deviation_m);
    patch.squared_mean = std::pow(sigma * normal(random), 2);
    result.push_back(patch);
  }
  return result;
}

TEST(UnexplainedSigma, IsFoundUnderNoiseOfAllSizes) {
  for (const double deviation_m : {0.002, 0.01, 0.1}) {
    EXPECT_NEAR(unexplained_sigma(patches(deviation_m, 0.0)), deviation_m, 0.07 * deviation_m);
  }
}

TEST(UnexplainedSigma, IsSmallWhereEverythingIsExplained) {
  EXPECT_LT(unexplained_sigma(patches(0.0, 0.0)), 3e-4);
  EXPECT_EQ(unexplained_sigma({}), 0.0);
  EXPECT_EQ(unexplained_sigma(std::vector<PatchMean>(100)), 0.0) << "points without noise, exactly on their planes";
}

TEST(UnexplainedSigma, DoesNotFollowAFewStrangePatches) {
  EXPECT_NEAR(unexplained_sigma(patches(0.004, 0.1)), 0.004, 0.001);
}

}  // namespace
}  // namespace dynamic_icp::mapping
