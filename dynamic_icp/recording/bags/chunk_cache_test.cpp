// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/chunk_cache.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::bags {
namespace {

/// Counts how often chunks are unpacked.
struct Unpacker {
  explicit Unpacker(std::size_t max_bytes) : cache(max_bytes) {}

  std::string get(std::uint64_t place) {
    return *cache.get(place, [&] {
      ++unpacked;
      return std::string(10, static_cast<char>('a' + place));
    });
  }

  ChunkCache cache;
  std::atomic<int> unpacked = 0;
};

TEST(ChunkCache, UnpacksNoneTwiceThatIsKept) {
  Unpacker chunks(30);
  for (int round = 0; round < 3; ++round) {
    for (std::uint64_t place = 0; place < 3; ++place) {
      EXPECT_EQ(chunks.get(place), std::string(10, static_cast<char>('a' + place)));
    }
  }
  EXPECT_EQ(chunks.unpacked, 3);
}

TEST(ChunkCache, ForgetsTheOneNotUsedForLongest) {
  Unpacker chunks(30);
  for (const std::uint64_t place : {0U, 1U, 2U, 0U, 3U}) {  // 1 goes
    chunks.get(place);
  }
  EXPECT_EQ(chunks.unpacked, 4);
  chunks.get(0);
  chunks.get(2);
  chunks.get(3);
  EXPECT_EQ(chunks.unpacked, 4);
  chunks.get(1);
  EXPECT_EQ(chunks.unpacked, 5);
}

TEST(ChunkCache, KeepsTheLastOneWhateverItsSize) {
  Unpacker chunks(0);
  chunks.get(0);
  chunks.get(0);
  EXPECT_EQ(chunks.unpacked, 1);
  chunks.get(1);
  chunks.get(0);
  EXPECT_EQ(chunks.unpacked, 3);
}

TEST(ChunkCache, TriesAgainAfterAFailure) {
  ChunkCache cache;
  const auto fail = []() -> std::string { throw std::runtime_error("damaged"); };
  EXPECT_THROW(cache.get(1, fail), std::runtime_error);
  EXPECT_THROW(cache.get(1, fail), std::runtime_error);
  EXPECT_EQ(*cache.get(1, [] { return std::string("whole"); }), "whole");
}

TEST(ChunkCache, UnpacksOnceForManyThreads) {
  Unpacker chunks(1000);
  {
    std::vector<std::jthread> threads;
    for (int k = 0; k < 8; ++k) {
      threads.emplace_back([&] {
        for (std::uint64_t place = 0; place < 20; ++place) {
          EXPECT_EQ(chunks.get(place), std::string(10, static_cast<char>('a' + place)));
        }
      });
    }
  }
  EXPECT_EQ(chunks.unpacked, 20);
}

}  // namespace
}  // namespace dynamic_icp::bags
