// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/learned_variance.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

TEST(LearnedVariance, ABetterEstimateReplacesTheOneBefore) {
  LearnedVariance once({.sigma = 1.0, .counts = 2.0, .min_sigma = 0.0, .max_sigma = 10.0});
  LearnedVariance again = once;
  once.update(0.81, 1.0);
  once.keep();
  again.update(9.0, 1.0);
  EXPECT_GT(again.value(), once.value());
  again.update(0.81, 1.0);
  again.keep();
  // The evidence is the same; the value may differ by how it was approached.
  for (LearnedVariance* variance : {&once, &again}) {
    variance->update(0.0, 0.0);
    variance->keep();
  }
  EXPECT_NEAR(once.value(), again.value(), 1e-12);
}

TEST(LearnedVariance, MacKaysFixedPointStaysWhereItIs) {
  LearnedVariance variance({.sigma = 2.0, .counts = 1.0, .min_sigma = 0.0, .max_sigma = 10.0});
  for (int k = 0; k < 50; ++k) {
    variance.update(4.0 * 3.0, 3.0);
    variance.keep();  // three known unknowns with squares of 4 each
  }
  EXPECT_NEAR(variance.value(), 4.0, 1e-9);
}

TEST(LearnedVariance, StaysWithinItsBounds) {
  LearnedVariance variance({.sigma = 1.0, .counts = 1.0, .min_sigma = 0.5, .max_sigma = 2.0});
  for (int k = 0; k < 20; ++k) {
    variance.update(1e6, 1.0);
    variance.keep();
  }
  EXPECT_DOUBLE_EQ(variance.value(), 4.0);
  for (int k = 0; k < 200; ++k) {
    variance.update(0.0, 1.0);
    variance.keep();
  }
  EXPECT_DOUBLE_EQ(variance.value(), 0.25);
}

}  // namespace
}  // namespace dynamic_icp::window
