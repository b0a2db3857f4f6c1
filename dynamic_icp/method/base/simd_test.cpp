// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/simd.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/lanes.hpp"

namespace dynamic_icp::simd {
namespace {

TEST(Simd, TheChosenLevelIsAmongThoseOfTheMachine) {
  const std::span<const Level> levels = available_levels();
  ASSERT_FALSE(levels.empty());
  EXPECT_EQ(levels.front(), Level::kBaseline);
  EXPECT_NE(std::ranges::find(levels, level()), levels.end());
}

TEST(Simd, AKernelGivesTheSameBitsAtEveryLevel) {
  constexpr std::size_t kWidth = 8;
  constexpr std::size_t kRows = 1000;
  std::vector<double> a(kRows);
  std::vector<double> b(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    a[i] = std::sin(static_cast<double>(i));
    b[i] = std::exp(std::cos(3.0 * static_cast<double>(i)));
  }
  const auto dot = [&](Level at) {
    double lanes[kWidth] = {};
    run(
        [&]() DYNAMIC_ICP_KERNEL {
          for (std::size_t i = 0; i < kRows; i += kWidth) {
            for (std::size_t l = 0; l < kWidth; ++l) {
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

// Built by clang, an alias of the type would have demanded addresses that are multiples of 32.
TEST(Lanes, AreLoadedAndStoredAtAnyAddressOfANumber) {
  std::vector<double> from(16);
  std::iota(from.begin(), from.end(), 1.0);
  for (std::size_t offset = 0; offset < kLanes; ++offset) {
    std::vector<double> to(16, 0.0);
    Lanes lanes;
    load(lanes, from.data() + offset);
    store(to.data() + offset + 1, lanes);
    EXPECT_EQ(to[offset + 1], from[offset]);
    EXPECT_EQ(to[offset + kLanes], from[offset + kLanes - 1]);
    EXPECT_EQ(sum(lanes), 4.0 * static_cast<double>(offset) + 10.0);
  }
}

}  // namespace
}  // namespace dynamic_icp::simd
