// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/selection.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp {
namespace {

using Values = std::vector<double>;

/// Values of all kinds, `n` of each.
std::vector<std::pair<std::string, Values>> kinds_of_values(std::size_t n) {
  const auto make = [n](const std::function<double(std::uint64_t, const RandomSource&)>& value) {
    Values values;
    for (std::uint64_t i = 0; i < n; ++i) {
      values.push_back(value(i, RandomSource(4).fork(i)));
    }
    return values;
  };
  return {
      {"random", make([](std::uint64_t, const RandomSource& one) { return one.normal(0); })},
      {"ascending", make([](std::uint64_t i, const RandomSource&) { return static_cast<double>(i); })},
      {"descending", make([](std::uint64_t i, const RandomSource&) { return -static_cast<double>(i); })},
      {"equal", make([](std::uint64_t, const RandomSource&) { return 3.0; })},
      {"in steps", make([](std::uint64_t, const RandomSource& one) { return std::round(2.0 * one.normal(0)); })},
      {"mostly zero", make([](std::uint64_t, const RandomSource& one) { return std::max(0.0, one.normal(0) - 1.0); })},
      {"up and down", make([n](std::uint64_t i, const RandomSource&) {
         return static_cast<double>(std::min<std::size_t>(i, n - i));
       })},
      {"of many sizes",
       make([](std::uint64_t i, const RandomSource&) { return std::exp2(static_cast<double>(i % 600)); })}};
}

TEST(SelectPlace, PutsTheValueThereThatSortingPutsThere) {
  for (const std::size_t n : {1u, 2u, 3u, 16u, 17u, 18u, 40u, 101u, 1000u, 5001u}) {
    for (const auto& [name, values] : kinds_of_values(n)) {
      Values ascending = values;
      std::ranges::sort(ascending);
      for (const std::size_t place : {std::size_t{0}, n / 10, n / 2, n - 1 - n / 3, n - 1}) {
        Values selected = values;
        select_place(selected, place);
        EXPECT_EQ(selected[place], ascending[place]) << place << " of " << n << ", " << name;
        const auto at = selected.begin() + static_cast<std::ptrdiff_t>(place);
        EXPECT_TRUE(std::all_of(selected.begin(), at, [&](double value) { return value <= *at; })) << name;
        EXPECT_TRUE(std::all_of(at, selected.end(), [&](double value) { return value >= *at; })) << name;
        std::ranges::sort(selected);
        EXPECT_EQ(selected, ascending) << "none is lost: " << name;
      }
    }
  }
}

TEST(FirstOutside, IsTheFirstOfWhateverNumberWhereverItStands) {
  using Limits = std::numeric_limits<double>;
  const double above = std::nextafter(2.0, 3.0);
  for (std::size_t n = 0; n < 40; ++n) {
    Values values(n, 2.0);  // the limits belong to it
    for (std::size_t i = 0; i < n; i += 2) {
      values[i] = -1.0;
    }
    EXPECT_EQ(first_outside(values, -1.0, 2.0), n);
    for (std::size_t place = 0; place < n; ++place) {
      for (const double other : {above, -1.5, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()}) {
        Values some = values;
        some[place] = other;
        some.back() = place + 1 == n ? other : 7.0;
        EXPECT_EQ(first_outside(some, -1.0, 2.0), place) << other << " of " << n;
      }
    }
  }
  EXPECT_EQ(first_outside(Values{1.0, Limits::max(), Limits::infinity()}, Limits::lowest(), Limits::max()), 2u);
}

}  // namespace
}  // namespace dynamic_icp
