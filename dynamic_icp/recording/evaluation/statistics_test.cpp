// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/statistics.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

TEST(Statistics, NothingHasNoStatistics) { EXPECT_FALSE(summarize({})); }

TEST(Statistics, OneValueIsEverything) {
  const std::vector<double> one = {2.5};
  const Statistics s = *summarize(one);
  EXPECT_EQ(s.count, 1u);
  for (const double value : {s.rmse, s.mean, s.median, s.p95, s.max}) {
    EXPECT_EQ(value, 2.5);
  }
}

TEST(Statistics, ByHand) {
  const std::vector<double> errors = {3.0, 0.0, 4.0, 1.0};
  const Statistics s = *summarize(errors);
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(26.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_DOUBLE_EQ(s.median, 2.0);
  EXPECT_DOUBLE_EQ(s.p95, 3.85);  // position 2.85 between 3 and 4
  EXPECT_EQ(s.max, 4.0);
}

TEST(Statistics, PercentilesInterpolateLinearly) {
  const std::vector<double> ascending = {10.0, 20.0, 30.0, 40.0, 50.0};
  EXPECT_EQ(percentile(ascending, 0.0), 10.0);
  EXPECT_EQ(percentile(ascending, 50.0), 30.0);
  EXPECT_EQ(percentile(ascending, 100.0), 50.0);
  EXPECT_NEAR(percentile(ascending, 90.0), 46.0, 1e-12);
  EXPECT_THROW(percentile({}, 50.0), std::invalid_argument);
  EXPECT_THROW(percentile(ascending, 101.0), std::invalid_argument);
}

TEST(Statistics, NoNumberRatherThanNaN) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(summarize(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(summarize(std::vector<double>{1.0, inf}));
  EXPECT_FALSE(summarize(std::vector<double>{1e200})) << "the square overflows";
}

}  // namespace
}  // namespace dynamic_icp::evaluation
