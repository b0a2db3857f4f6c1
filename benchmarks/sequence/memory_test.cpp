// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/memory.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::speed {
namespace {

constexpr double kBlock_mib = 64.0;

// What is touched between two readings, and what the system counts late.
constexpr double kSlack_mib = 1.0;

/// Uses so much memory and gives it back.
void use_a_block() {
  std::vector<char> block(static_cast<std::size_t>(kBlock_mib) << 20);
  std::fill(block.begin(), block.end(), 'x');
  volatile char sink = block[block.size() / 2];
  (void)sink;
}

TEST(Memory, ThePeakRemembersWhatWasGivenBack) {
  if (resident_mib() == 0.0) {
    GTEST_SKIP() << "the system does not tell";
  }
  const double before = resident_mib();
  use_a_block();
  EXPECT_GE(peak_resident_mib(), before + 0.9 * kBlock_mib);
  EXPECT_GE(peak_resident_mib() + kSlack_mib, resident_mib());
}

TEST(Memory, ThePeakCanBeginAnew) {
  use_a_block();
  const double peak = peak_resident_mib();
  if (!restart_peak()) {
    GTEST_SKIP() << "the system cannot";
  }
  EXPECT_LE(peak_resident_mib(), peak + kSlack_mib);
  EXPECT_GE(peak_resident_mib(), 0.9 * resident_mib());
}

}  // namespace
}  // namespace dynamic_icp::speed
