// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/send_queue.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace dynamic_icp::live {
namespace {

Outgoing message(std::size_t channel, std::int64_t number, std::size_t bytes) {
  return {channel, static_cast<std::uint32_t>(10 + channel), Stamp{number},
          std::make_shared<const std::string>(bytes, 'x')};
}

std::vector<std::int64_t> numbers_left(SendQueue& queue) {
  std::vector<std::int64_t> numbers;
  while (const auto next = queue.pop()) {
    numbers.push_back(next->stamp.ns);
  }
  return numbers;
}

constexpr std::size_t kThird = SendQueue::kMaxBytes / 3;

TEST(SendQueue, KeepsTheOrderAndAllThatFits) {
  SendQueue queue;
  for (int k = 0; k < 3; ++k) {
    queue.push(message(static_cast<std::size_t>(k % 2), k, kThird));
  }
  EXPECT_EQ(numbers_left(queue), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(queue.take_left_out(), 0u);
}

TEST(SendQueue, TheNewestOfAChannelWins) {
  SendQueue queue;
  queue.push(message(1, 0, 100));  // small ones of another channel stay
  for (int k = 1; k <= 10; ++k) {
    queue.push(message(0, k, kThird - 50));
  }
  EXPECT_EQ(numbers_left(queue), (std::vector<std::int64_t>{0, 8, 9, 10}));
  EXPECT_EQ(queue.take_left_out(), 7u);
  EXPECT_EQ(queue.take_left_out(), 0u);
}

TEST(SendQueue, ManySmallMessagesAreBoundedToo) {
  SendQueue queue;
  for (int k = 0; k < 1000; ++k) {
    queue.push(message(0, k, 1));
  }
  const std::vector<std::int64_t> left = numbers_left(queue);
  EXPECT_EQ(left.size(), SendQueue::kMaxMessages);
  EXPECT_EQ(left.back(), 999);
}

TEST(SendQueue, OneMessageMayBeLargerThanTheLimit) {
  SendQueue queue;
  queue.push(message(0, 0, 2 * SendQueue::kMaxBytes));
  queue.push(message(1, 1, 10));
  EXPECT_EQ(numbers_left(queue), (std::vector<std::int64_t>{1}));
  queue.push(message(0, 2, 2 * SendQueue::kMaxBytes));
  EXPECT_EQ(numbers_left(queue), (std::vector<std::int64_t>{2}));
}

TEST(SendQueue, WhatAnEndedSubscriptionWaitedForIsLeftOutWithoutBlame) {
  SendQueue queue;
  queue.push(message(0, 0, 10));
  queue.push(message(1, 1, 10));
  queue.end(10);
  EXPECT_EQ(numbers_left(queue), (std::vector<std::int64_t>{1}));
  EXPECT_EQ(queue.take_left_out(), 0u);
}

}  // namespace
}  // namespace dynamic_icp::live
