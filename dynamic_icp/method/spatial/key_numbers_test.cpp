// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/key_numbers.hpp"

#include <random>
#include <unordered_map>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

TEST(KeyNumbers, NumbersKeysAsTheyCome) {
  std::mt19937_64 random(2);
  KeyNumbers numbers;
  for (const std::uint64_t different : {10U, 3000U, 100'000U}) {
    numbers.clear();
    std::unordered_map<std::uint64_t, std::uint32_t> expected;
    for (int i = 0; i < 50'000; ++i) {
      // Neighbouring keys and keys that differ in high bits only.
      const std::uint64_t key = (random() % different) << (i % 2 == 0 ? 0 : 42);
      const auto number = static_cast<std::uint32_t>(expected.size());
      EXPECT_EQ(numbers.find(key), expected.contains(key) ? expected[key] : KeyNumbers::kNone);
      EXPECT_EQ(numbers.number_of(key), expected.try_emplace(key, number).first->second);
    }
    EXPECT_EQ(numbers.count(), expected.size());
  }
}

}  // namespace
}  // namespace dynamic_icp::spatial
