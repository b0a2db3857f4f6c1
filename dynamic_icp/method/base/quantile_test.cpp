// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp {
namespace {

TEST(Quantile, HasTheStatedShareOfTheValuesBelowIt) {
  const RandomSource random(8);
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 1001; ++i) {
    values.push_back(random.uniform(i));
  }
  for (const double share : {0.0, 0.05, 0.25, 0.5, 0.95, 1.0}) {
    const double found = quantile(values, share);
    EXPECT_EQ(std::count(values.begin(), values.end(), found), 1) << "one of the values";
    EXPECT_EQ(std::count_if(values.begin(), values.end(), [&](double value) { return value < found; }),
              std::lround(1000.0 * share));
  }
}

TEST(Quantile, MedianIsTheMiddleValueOrTheUpperOfTwo) {
  EXPECT_EQ(median({5.0, -1.0, 3.0}), 3.0);
  EXPECT_EQ(median({5.0, -1.0, 3.0, 4.0}), 4.0);
  EXPECT_EQ(median({2.0, 7.0}), 7.0);
  EXPECT_EQ(median({2.0}), 2.0);
}

TEST(Quantile, InterpolatedMedianIsHalfWayBetweenTheTwoInTheMiddle) {
  const auto found = [](std::vector<double> values) { return interpolated_median_among(values); };
  EXPECT_EQ(found({5.0, -1.0, 3.0}), 3.0);
  EXPECT_EQ(found({5.0, -1.0, 3.0, 4.0}), 3.5);
  EXPECT_EQ(found({7.0, 2.0}), 4.5);
  EXPECT_EQ(found({2.0}), 2.0);
  const RandomSource random(9);
  for (std::uint64_t n = 1; n < 40; ++n) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < n; ++i) {
      values.push_back(std::round(4.0 * random.fork(n).normal(i)));  // some are equal
    }
    std::vector<double> ascending = values;
    std::ranges::sort(ascending);
    EXPECT_EQ(found(values), 0.5 * (ascending[(n - 1) / 2] + ascending[n / 2])) << n;
  }
}

TEST(Quantile, OfNothingIsZero) {
  EXPECT_EQ(quantile({}, 0.3), 0.0);
  EXPECT_EQ(median({}), 0.0);
}

}  // namespace
}  // namespace dynamic_icp
