// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/bucket_sort.hpp"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::dynamics {
namespace {

std::vector<std::uint32_t> random_numbers(std::size_t count, std::uint32_t largest) {
  std::mt19937 random(7);
  std::vector<std::uint32_t> numbers(count);
  for (std::uint32_t& number : numbers) {
    number = static_cast<std::uint32_t>(random() % (largest + 1));
  }
  return numbers;
}

TEST(BucketSort, SortsInsideBucketsAndAcrossThem) {
  for (const std::size_t count : {0, 1, 2, 17, 1000}) {
    for (const std::uint32_t width : {1, 10, 1000}) {  // of a bucket
      std::vector<std::uint32_t> numbers = random_numbers(count, 999);
      std::vector<std::uint32_t> expected = numbers;
      std::sort(expected.begin(), expected.end());
      bucket_sort(
          numbers, 1000 / width, [=](std::uint32_t number) { return number / width; }, std::less<>());
      EXPECT_EQ(numbers, expected) << count << " numbers, buckets of " << width;
    }
  }
}

TEST(BucketSort, NumberOfBucketsGrowsWithTheItemsUpToALimit) {
  EXPECT_EQ(bucket_count_for(0), 1u);
  EXPECT_EQ(bucket_count_for(1), 1u);
  EXPECT_EQ(bucket_count_for(2000), 2048u);
  EXPECT_EQ(bucket_count_for(1'000'000'000), 65536u);
}

}  // namespace
}  // namespace dynamic_icp::dynamics
