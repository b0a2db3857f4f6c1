// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/flags.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

TEST(Flags, ThoseThatAreNotZeroAreVisitedAndCountedInAnyPart) {
  std::vector<std::uint8_t> flags(200);
  for (std::uint64_t i = 0; i < flags.size(); ++i) {
    const RandomSource one = RandomSource(2).fork(i);
    flags[i] = one.uniform(0) < 0.4 ? static_cast<std::uint8_t>(one.bits(1)) : 0;  // any bits
  }
  flags[3] = 0x80;
  flags[4] = 0xff;
  flags[5] = 0x01;
  for (std::size_t begin = 0; begin < 20; ++begin) {
    for (std::size_t end = begin; end <= flags.size(); end += 7) {
      std::vector<std::size_t> expected;
      for (std::size_t i = begin; i < end; ++i) {
        if (flags[i] != 0) {
          expected.push_back(i);
        }
      }
      std::vector<std::size_t> visited;
      visit_flagged(flags, begin, end, [&](std::size_t i) { visited.push_back(i); });
      EXPECT_EQ(visited, expected);
      EXPECT_EQ(count_flagged(flags, begin, end), expected.size());
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
