// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/machine.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace dynamic_icp::benchmark {
namespace {

TEST(Machine, IsDescribedOnOneLine) {
  const std::string text = describe_machine();
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.find(describe_processor()), 0u);
  EXPECT_NE(text.find(std::to_string(std::thread::hardware_concurrency()) + " processors"), std::string::npos) << text;
  EXPECT_NE(text.find("memory"), std::string::npos) << text;
}

TEST(Machine, TellsTheMemoryThatIsLeft) {
  const auto available = available_memory_mib();
  if (available) {
    EXPECT_GT(*available, 1.0);
    EXPECT_LT(*available, 1e9);
  }
}

}  // namespace
}  // namespace dynamic_icp::benchmark
