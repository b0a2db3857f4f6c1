// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/simd.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::simd {
namespace {

TEST(Simd, TheChosenLevelIsAmongThoseOfTheMachine) {
  const std::span<const Level> levels = available_levels();
  ASSERT_FALSE(levels.empty());
  EXPECT_EQ(levels.front(), Level::kBaseline);
  EXPECT_NE(std::ranges::find(levels, level()), levels.end());
}

TEST(Simd, AKernelGivesTheSameBitsAtEveryLevel) {
  constexpr std::size_t kLanes = 8;
  constexpr std::size_t kRows = 1000;
  std::vector<double> a(kRows);
  std::vector<double> b(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    a[i] = std::sin(static_cast<double>(i));
    b[i] = std::exp(std::cos(3.0 * static_cast<double>(i)));
  }
  const auto dot = [&](Level at) {
    double lanes[kLanes] = {};
    run(
        [&]() DYNAMIC_ICP_KERNEL {
          for (std::size_t i = 0; i < kRows; i += kLanes) {
            for (std::size_t l = 0; l < kLanes; ++l) {
              lanes[l] += a[i + l] * b[i + l];
            }
          }
        },
        at);
    double sum = 0.0;
    for (const double lane : lanes) {
      sum += lane;
    }
    return sum;
  };
  double expected = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    expected += a[i] * b[i];
  }
  EXPECT_NEAR(dot(Level::kBaseline), expected, 1e-9);
  for (const Level at : available_levels()) {
    EXPECT_EQ(dot(at), dot(Level::kBaseline));
  }
}

}  // namespace
}  // namespace dynamic_icp::simd
