// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace dynamic_icp {
namespace {

TEST(Workers, VisitsEveryIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    const Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{1000}}) {
      std::vector<int> visits(n, 0);
      workers.for_each(n, 64, [&](std::size_t i) { ++visits[i]; });
      EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), static_cast<int>(n));
      EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](int v) { return v == 1; }));
    }
  }
}

TEST(Workers, SumsAreTheSameBitsForAnyNumberOfThreads) {
  // Terms of very different size, so that any other order of additions shows in the last bits.
  const std::size_t n = 100'000;
  std::vector<double> terms(n);
  for (std::size_t i = 0; i < n; ++i) {
    terms[i] = std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 17) - 8.0);
  }
  const auto sum = [&](int threads) {
    return Workers(threads).sum_blocks(n, 512, 0.0, [&](std::size_t begin, std::size_t end) {
      return std::accumulate(terms.begin() + static_cast<std::ptrdiff_t>(begin),
                             terms.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
    });
  };
  const double expected = sum(1);
  for (const int threads : {2, 3, 7}) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      EXPECT_EQ(sum(threads), expected);
    }
  }
}

TEST(Workers, KeepTheirOwnLimits) {
  const Workers one(1);
  const Workers three(3);
  EXPECT_EQ(one.threads(), 1);
  EXPECT_EQ(three.threads(), 3);
}

TEST(Workers, LoopsInsideLoopsAndFromSeveralThreadsComplete) {
  const Workers workers(3);
  std::atomic<int> count = 0;
  const auto nested = [&] {
    workers.for_each(20, 1, [&](std::size_t) { workers.for_each(10, 3, [&](std::size_t) { ++count; }); });
  };
  std::thread other(nested);
  nested();
  other.join();
  EXPECT_EQ(count, 2 * 20 * 10);
}

TEST(Workers, WhoIsDoneHelpsWithTheLoopsOfTheOtherTask) {
  const Workers workers(2);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  workers.both([] {},
               [&] {
                 // Each block waits until both threads are in the loop: alone no thread gets through in time.
                 const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
                 workers.for_each(2, 1, [&](std::size_t) {
                   while (std::chrono::steady_clock::now() < end) {
                     const std::lock_guard lock(mutex);
                     threads.insert(std::this_thread::get_id());
                     if (threads.size() == 2) {
                       return;
                     }
                   }
                 });
               });
  EXPECT_EQ(threads.size(), 2u);
}

TEST(Workers, DeepAndManyLoopsComplete) {
  for (const int threads : {2, 3, 5}) {
    const Workers workers(threads);
    std::atomic<int> count = 0;
    for (int round = 0; round < 50; ++round) {
      workers.for_each(30, 1, [&](std::size_t) {
        workers.both([&] { workers.for_each(4, 1, [&](std::size_t) { ++count; }); },
                     [&] { workers.for_each(3, 1, [&](std::size_t) { ++count; }); });
      });
    }
    EXPECT_EQ(count, 50 * 30 * 7) << threads;
  }
}

TEST(Workers, ExceptionsOfInnerLoopsReachTheOuterCaller) {
  const Workers workers(3);
  const auto inner = [&](std::size_t i) {
    workers.for_each(10, 1, [&](std::size_t k) {
      if (i == 3 && k == 7) {
        throw std::runtime_error("stop");
      }
    });
  };
  EXPECT_THROW(workers.for_each(8, 1, inner), std::runtime_error);
}

TEST(Workers, PassExceptionsOn) {
  const Workers workers(2);
  EXPECT_THROW(workers.for_each(1000, 10,
                                [](std::size_t i) {
                                  if (i == 500) {
                                    throw std::runtime_error("stop");
                                  }
                                }),
               std::runtime_error);
  EXPECT_THROW(Workers(-1), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp
