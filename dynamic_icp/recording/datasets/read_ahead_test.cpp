// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/read_ahead.hpp"

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

/// Scans without points that carry their index as stamp; `broken` cannot be read.
class Numbers final : public Dataset {
 public:
  [[nodiscard]] std::string_view format() const override { return "numbers"; }
  [[nodiscard]] std::size_t size() const override { return 5; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return Stamp{static_cast<std::int64_t>(index)}; }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t) const override { return {}; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return assumptions_; }
  [[nodiscard]] RawScan scan(std::size_t index) const override {
    if (index == broken) {
      throw DataError("scan " + std::to_string(index) + " is broken");
    }
    RawScan scan;
    scan.stamp = stamp(index);
    ++begun;
    return scan;
  }

  std::size_t broken = 99;
  mutable std::atomic<int> begun = 0;

 private:
  formats::Trajectory truth_;
  std::vector<std::string> assumptions_;
};

TEST(ReadAhead, GivesTheScansInOrder) {
  const Numbers numbers;
  ReadAhead scans(numbers, 1, 4);
  for (std::int64_t expected = 1; expected < 4; ++expected) {
    ASSERT_FALSE(scans.done());
    EXPECT_EQ(scans.next().stamp.ns, expected);
  }
  EXPECT_TRUE(scans.done());
  EXPECT_EQ(numbers.begun, 3) << "nothing beyond the end is read";
}

TEST(ReadAhead, ReadsTheNextScanUnasked) {
  const Numbers numbers;
  ReadAhead scans(numbers, 0, 5);
  scans.next();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (numbers.begun < 2 && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  EXPECT_EQ(numbers.begun, 2) << "one ahead, no more";
}

TEST(ReadAhead, FaultsComeWhenTheirScanIsAskedFor) {
  Numbers numbers;
  numbers.broken = 1;
  ReadAhead scans(numbers, 0, 5);
  EXPECT_EQ(scans.next().stamp.ns, 0);
  EXPECT_THROW(scans.next(), DataError);
}

TEST(ReadAhead, NothingToReadIsDoneAtOnce) {
  const Numbers numbers;
  EXPECT_TRUE(ReadAhead(numbers, 2, 2).done());
}

}  // namespace
}  // namespace dynamic_icp::datasets
