// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/timing.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace dynamic_icp::speed {
namespace {

TEST(Timing, MedianIsTheMiddleWhateverTheOrder) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
  EXPECT_EQ(median({7.0}), 7.0);
}

TEST(Timing, PercentilesInterpolateBetweenNeighbours) {
  std::vector<double> times;
  for (int i = 200; i >= 0; --i) {
    times.push_back(0.5 * i);  // 0 to 100: the percentile is the value
  }
  const Percentiles all = percentiles(times);
  EXPECT_DOUBLE_EQ(all.p50, 50.0);
  EXPECT_DOUBLE_EQ(all.p95, 95.0);
  EXPECT_DOUBLE_EQ(all.p99, 99.0);
  EXPECT_EQ(all.max, 100.0);
  EXPECT_DOUBLE_EQ(percentiles({10.0, 20.0}).p95, 19.5);
}

TEST(Timing, NothingHasNoPercentiles) {
  EXPECT_THROW(percentiles({}), std::invalid_argument);
  EXPECT_THROW(median({}), std::invalid_argument);
}

TEST(Timing, RunsAreToldByMedianAndSpread) {
  const std::vector<double> runs = {12.0, 10.0, 30.0};
  const Repeated told = repeated(runs);
  EXPECT_EQ(told.median, 12.0);
  EXPECT_EQ(told.min, 10.0);
  EXPECT_EQ(told.max, 30.0);
}

TEST(Timing, GrowthIsTheExponentOfAPowerLaw) {
  const std::vector<double> sizes = {1e4, 3e4, 7e4, 2e5, 1e6};
  for (const double exponent : {0.0, 0.8, 1.0, 2.0}) {
    std::vector<double> times;
    for (const double size : sizes) {
      times.push_back(0.003 * std::pow(size, exponent));
    }
    const auto found = growth_exponent(sizes, times);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(*found, exponent, 1e-12);
  }
}

TEST(Timing, GrowthIsTheLeastSquaresSlope) {
  // log2 of the sizes 0, 1, 2 and of the times 0, 2, 1: mean of both 1, slope (-1 * -1 + 1 * 0) / 2.
  const auto found = growth_exponent(std::vector<double>{1.0, 2.0, 4.0}, std::vector<double>{1.0, 4.0, 2.0});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(*found, 0.5, 1e-12);
}

TEST(Timing, NoGrowthWithoutTwoSizesAndPositiveTimes) {
  EXPECT_FALSE(growth_exponent({}, {}));
  EXPECT_FALSE(growth_exponent(std::vector<double>{5.0}, std::vector<double>{1.0}));
  EXPECT_FALSE(growth_exponent(std::vector<double>{5.0, 5.0}, std::vector<double>{1.0, 2.0}));
  EXPECT_FALSE(growth_exponent(std::vector<double>{5.0, 6.0}, std::vector<double>{0.0, 2.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(growth_exponent(std::vector<double>{5.0, 6.0}, std::vector<double>{nan, 2.0}));
  EXPECT_THROW(growth_exponent(std::vector<double>{5.0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::speed
