// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/robust_kernel.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::estimation {
namespace {

using Function = double (*)(double, double);
struct Kernel {
  const char* name;
  Function loss;
  Function weight;
};

double huber_loss(double e, double k) { return std::abs(e) <= k ? 0.5 * e * e : k * std::abs(e) - 0.5 * k * k; }

double geman_mcclure_loss(double e, double k) { return 0.5 * e * e * k * k / (k * k + e * e); }

class RobustKernel : public ::testing::TestWithParam<Kernel> {};

TEST_P(RobustKernel, WeightIsTheSlopeOfTheLossOverTheResidual) {
  for (const double k : {0.1, 0.3, 1.0, 3.0}) {
    for (const double ratio : {-4.0, -1.3, -0.7, 0.2, 0.5, 0.99, 1.01, 2.0, 10.0}) {
      const double e = ratio * k;
      const double h = 1e-6 * k;
      const double slope = (GetParam().loss(e + h, k) - GetParam().loss(e - h, k)) / (2.0 * h);
      EXPECT_NEAR(GetParam().weight(e, k), slope / e, 1e-6) << GetParam().name << " e/k = " << ratio;
    }
  }
}

TEST_P(RobustKernel, WeightDependsOnTheRatioAlone) {
  for (const double ratio : {0.0, 0.3, 0.9, 1.5, 2.0, 7.0}) {
    const double expected = GetParam().weight(ratio, 1.0);
    for (const double k : {1e-3, 0.1, 3.0, 1e3}) {
      EXPECT_NEAR(GetParam().weight(ratio * k, k), expected, 1e-12);
    }
  }
}

TEST_P(RobustKernel, IsLeastSquaresNearZero) {
  EXPECT_EQ(GetParam().weight(0.0, 0.3), 1.0);
  EXPECT_EQ(GetParam().loss(0.0, 0.3), 0.0);
  EXPECT_NEAR(GetParam().loss(1e-4, 0.3) / (0.5e-8), 1.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Kernels, RobustKernel,
                         ::testing::Values(Kernel{"huber", huber_loss, huber_weight},
                                           Kernel{"tukey", tukey_loss, tukey_weight},
                                           Kernel{"geman_mcclure", geman_mcclure_loss, geman_mcclure_weight}),
                         [](const auto& kernel) { return kernel.param.name; });

TEST(TukeyWeight, VanishesBeyondTheScale) {
  EXPECT_EQ(tukey_weight(0.5, 0.5), 0.0);
  EXPECT_EQ(tukey_weight(-7.0, 0.5), 0.0);
  EXPECT_NEAR(tukey_weight(0.25, 0.5), 0.5625, 1e-15);
}

TEST(GemanMcClureWeight, FallsToAQuarterAtTheScaleAndNeverToZero) {
  EXPECT_NEAR(geman_mcclure_weight(-0.5, 0.5), 0.25, 1e-15);
  EXPECT_NEAR(geman_mcclure_weight(1.5, 0.5), 0.01, 1e-15);
  EXPECT_GT(geman_mcclure_weight(500.0, 0.5), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::estimation
