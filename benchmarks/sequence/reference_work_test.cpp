// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/reference_work.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::speed {
namespace {

TEST(ReferenceWork, ReadsTheTimeThatIsPrinted) {
  EXPECT_EQ(parse_milliseconds("21.750\n", "p"), 21.75);
  EXPECT_EQ(parse_milliseconds("  3 \r\n", "p"), 3.0);
}

TEST(ReferenceWork, RefusesWhatIsNoTime) {
  for (const char* printed : {"", "\n", "fast", "12 ms", "0", "-3", "nan", "inf"}) {
    EXPECT_THROW(parse_milliseconds(printed, "p"), DataError) << printed;
  }
}

}  // namespace
}  // namespace dynamic_icp::speed
