// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::datasets {
namespace {

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;
constexpr std::int64_t kFirst_ns = 1'700'000'000 * kOneSecond_ns;

std::vector<std::int64_t> recorded(std::size_t messages) {
  std::vector<std::int64_t> times_ns;
  for (std::size_t i = 0; i < messages; ++i) {
    times_ns.push_back(kFirst_ns + static_cast<std::int64_t>(i) * kOneSecond_ns / 10);
  }
  return times_ns;
}

/// Headers a little before the times of recording.
std::vector<Stamp> headers(std::size_t messages, std::int64_t before_ns = 5'000'000) {
  std::vector<Stamp> stamps;
  for (const std::int64_t ns : recorded(messages)) {
    stamps.push_back({ns - before_ns});
  }
  return stamps;
}

TEST(BagStamps, HeadersThatAreSaneAreTakenWithoutAWord) {
  const ChosenStamps chosen = choose_stamps(recorded(10), headers(10), "/p");
  EXPECT_FALSE(chosen.are_recorded);
  EXPECT_EQ(chosen.stamps, headers(10));
  EXPECT_TRUE(chosen.assumptions.empty());
}

TEST(BagStamps, ZerosGiveWayToTheTimesOfRecording) {
  const ChosenStamps chosen = choose_stamps(recorded(10), std::vector<Stamp>(10), "/p");
  EXPECT_TRUE(chosen.are_recorded);
  EXPECT_EQ(chosen.stamps[3].ns, recorded(10)[3]);
  ASSERT_EQ(chosen.assumptions.size(), 1U);
  EXPECT_EQ(chosen.assumptions[0], "topic '/p': the timestamps in its headers are 0: the times of recording are taken");
}

TEST(BagStamps, SimulatedTimeBeginsAtZero) {
  const std::vector<std::int64_t> times = {0, 100'000'000, 200'000'000};
  const std::vector<Stamp> stamps = {{0}, {100'000'000}, {200'000'000}};
  EXPECT_EQ(choose_stamps(times, stamps, "/p").stamps, stamps);
  const ChosenStamps zeros = choose_stamps(times, std::vector<Stamp>(3), "/p");
  EXPECT_TRUE(zeros.are_recorded);
  EXPECT_NE(zeros.assumptions.at(0).find("headers are 0"), std::string::npos) << zeros.assumptions[0];
}

TEST(BagStamps, SoDoHeadersOfAnotherClock) {
  const ChosenStamps before = choose_stamps(recorded(10), headers(10, 335'000 * kOneSecond_ns), "/p");
  EXPECT_TRUE(before.are_recorded);
  ASSERT_EQ(before.assumptions.size(), 1U);
  EXPECT_NE(before.assumptions[0].find("lie 335000 s before the times of recording"), std::string::npos)
      << before.assumptions[0];
  EXPECT_TRUE(choose_stamps(recorded(10), headers(10, -3601 * kOneSecond_ns), "/p").are_recorded);
  EXPECT_FALSE(choose_stamps(recorded(10), headers(10, -3599 * kOneSecond_ns), "/p").are_recorded);
  EXPECT_TRUE(choose_stamps(recorded(2), std::vector<Stamp>{{INT64_MIN}, {INT64_MAX}}, "/p").are_recorded);
}

TEST(BagStamps, AFewBadHeadersCostTheirMessagesOnly) {
  std::vector<Stamp> some = headers(10);
  some[2].ns = 0;
  some[5].ns += 100 * kOneSecond_ns;  // the later ones are not before it by their own fault
  some[7] = some[6];
  const ChosenStamps chosen = choose_stamps(recorded(10), some, "/p");
  EXPECT_FALSE(chosen.are_recorded);
  EXPECT_EQ(chosen.kept, (std::vector<std::size_t>{0, 1, 3, 4, 6, 8, 9}));
  ASSERT_EQ(chosen.assumptions.size(), 2U);
  EXPECT_NE(chosen.assumptions[0].find("2 of 9 messages are left out"), std::string::npos) << chosen.assumptions[0];
  EXPECT_NE(chosen.assumptions[1].find("1 of 10 messages are left out"), std::string::npos) << chosen.assumptions[1];
}

TEST(BagStamps, HeadersOutOfOrderThroughoutAreNone) {
  std::vector<Stamp> backwards = headers(10);
  std::reverse(backwards.begin(), backwards.end());
  const ChosenStamps chosen = choose_stamps(recorded(10), backwards, "/p");
  EXPECT_TRUE(chosen.are_recorded);
  EXPECT_NE(chosen.assumptions.at(0).find("are not in order"), std::string::npos);
  EXPECT_EQ(chosen.stamps.size(), 10U);
}

TEST(BagStamps, OfEqualTimesOfRecordingOneStays) {
  std::vector<std::int64_t> times = recorded(4);
  times[2] = times[1];
  const ChosenStamps chosen = recorded_stamps(times, "/p");
  EXPECT_EQ(chosen.kept, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(chosen.assumptions.size(), 1U);
}

TEST(BagStamps, TheLongestIncreasingSequence) {
  const auto of = [](std::vector<std::int64_t> numbers) {
    std::vector<Stamp> stamps;
    for (const std::int64_t number : numbers) {
      stamps.push_back({number});
    }
    return longest_increasing(stamps);
  };
  EXPECT_TRUE(of({}).empty());
  EXPECT_EQ(of({5}), (std::vector<std::size_t>{0}));
  EXPECT_EQ(of({1, 9, 2, 3, 8, 4, 5}), (std::vector<std::size_t>{0, 2, 3, 5, 6}));
  EXPECT_EQ(of({3, 3, 3}).size(), 1U);
  EXPECT_EQ(of({1, 2, 3, 1, 2}), (std::vector<std::size_t>{0, 1, 2}));  // a recording played again
}

}  // namespace
}  // namespace dynamic_icp::datasets
