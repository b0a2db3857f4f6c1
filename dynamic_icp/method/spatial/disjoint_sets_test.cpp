// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/spatial/disjoint_sets.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::spatial {
namespace {

TEST(DisjointSets, StartAlone) {
  DisjointSets sets(3);
  EXPECT_EQ(sets.count(), 3u);
  EXPECT_NE(sets.find(0), sets.find(1));
  EXPECT_NE(sets.find(1), sets.find(2));
  EXPECT_EQ(DisjointSets(0).count(), 0u);
  sets.unite(0, 2);
  sets.reset(4);
  EXPECT_EQ(sets.count(), 4u);
  EXPECT_NE(sets.find(0), sets.find(2));
  EXPECT_EQ(sets.size(sets.find(3)), 1u);
}

TEST(DisjointSets, AgreeWithRelabellingEveryMember) {
  std::mt19937 random(1);
  const std::uint32_t n = 200;
  DisjointSets sets(n);
  std::vector<std::uint32_t> label(n);
  std::iota(label.begin(), label.end(), 0u);
  for (int step = 0; step < 300; ++step) {
    const auto a = static_cast<std::uint32_t>(random() % n);
    const auto b = static_cast<std::uint32_t>(random() % n);
    EXPECT_EQ(sets.unite(a, b), label[a] != label[b]);
    std::replace(label.begin(), label.end(), std::uint32_t{label[b]}, std::uint32_t{label[a]});
    const auto x = static_cast<std::uint32_t>(random() % n);
    const auto y = static_cast<std::uint32_t>(random() % n);
    EXPECT_EQ(sets.find(x) == sets.find(y), label[x] == label[y]);
    EXPECT_EQ(sets.size(sets.find(x)), std::count(label.begin(), label.end(), label[x]));
  }
  std::sort(label.begin(), label.end());
  EXPECT_EQ(sets.count(), static_cast<std::size_t>(std::unique(label.begin(), label.end()) - label.begin()));
}

}  // namespace
}  // namespace dynamic_icp::spatial
