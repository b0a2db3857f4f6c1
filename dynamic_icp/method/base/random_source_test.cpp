// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/random_source.hpp"

#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp {
namespace {

constexpr int kDraws = 200'000;

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

Moments moments(const std::function<double(std::uint64_t)>& draw) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = draw(i);
    sum += x;
    squares += x * x;
  }
  const double mean = sum / kDraws;
  return {mean, squares / kDraws - mean * mean};
}

TEST(RandomSource, IsAFunctionOfItsPlaceOnly) {
  const RandomSource source(7);
  const double later = source.fork(3).fork(5).normal(1);
  (void)source.uniform(0);
  EXPECT_EQ(RandomSource(7).fork(3).fork(5).normal(1), later);
}

TEST(RandomSource, PlacesDoNotShareNumbers) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t part = 0; part < 20; ++part) {
      for (std::uint64_t stream = 0; stream < 20; ++stream) {
        seen.insert(RandomSource(seed).fork(part).bits(stream));
        seen.insert(RandomSource(seed).fork(part).fork(stream).bits(part));
      }
    }
  }
  EXPECT_EQ(seen.size(), 2U * 20 * 20 * 20);
}

TEST(RandomSource, UniformNumbersHaveTheirMoments) {
  const RandomSource source(1);
  const auto over_streams = moments([&](std::uint64_t i) { return source.uniform(i); });
  const auto over_forks = moments([&](std::uint64_t i) { return source.fork(i).uniform(0); });
  const auto over_seeds = moments([&](std::uint64_t i) { return RandomSource(i).uniform(0); });
  for (const Moments& m : {over_streams, over_forks, over_seeds}) {
    EXPECT_NEAR(m.mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kDraws));
    EXPECT_NEAR(m.variance, 1.0 / 12.0, 4.0 * std::sqrt(1.0 / 180.0 / kDraws));
  }
}

TEST(RandomSource, UniformNumbersStayInTheirInterval) {
  const RandomSource source(2);
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    const double x = source.uniform(i, -3.0, 5.0);
    EXPECT_GE(x, -3.0);
    EXPECT_LT(x, 5.0);
  }
}

TEST(RandomSource, NormalNumbersHaveTheirMomentsAndTails) {
  const RandomSource source(3);
  const auto m = moments([&](std::uint64_t i) { return source.fork(i).normal(2); });
  EXPECT_NEAR(m.mean, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(m.variance, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
  for (const double limit : {1.0, 2.0, 3.0}) {
    const auto beyond =
        moments([&](std::uint64_t i) { return std::abs(source.fork(i).normal(2)) > limit ? 1.0 : 0.0; });
    const double expected = std::erfc(limit / std::sqrt(2.0));
    EXPECT_NEAR(beyond.mean, expected, 4.0 * std::sqrt(expected / kDraws)) << limit;
  }
}

TEST(RandomSource, NeighbouringPlacesAreUncorrelated) {
  const RandomSource source(4);
  const auto streams = moments([&](std::uint64_t i) { return source.fork(i).normal(0) * source.fork(i).normal(1); });
  const auto forks = moments([&](std::uint64_t i) { return source.fork(i).normal(0) * source.fork(i + 1).normal(0); });
  const auto kinds =
      moments([&](std::uint64_t i) { return source.fork(i).normal(0) * (source.fork(i).uniform(0) - 0.5); });
  EXPECT_NEAR(streams.mean, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(forks.mean, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(kinds.mean, 0.0, 4.0 / std::sqrt(kDraws));
}

}  // namespace
}  // namespace dynamic_icp
