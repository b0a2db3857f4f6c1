// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/stamp.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp {
namespace {

TEST(Stamp, ParsesDecimalSecondsExactly) {
  EXPECT_EQ(parse_seconds("1724479779.384729506")->ns, 1724479779384729506);
  EXPECT_EQ(parse_seconds("0")->ns, 0);
  EXPECT_EQ(parse_seconds("12")->ns, 12'000'000'000);
  EXPECT_EQ(parse_seconds("0.1")->ns, 100'000'000);
  EXPECT_EQ(parse_seconds(".5")->ns, 500'000'000);
  EXPECT_EQ(parse_seconds("5.")->ns, 5'000'000'000);
  EXPECT_EQ(parse_seconds("+0.000000001")->ns, 1);
  EXPECT_EQ(parse_seconds("-0.000000001")->ns, -1);
}

TEST(ParseUnixTime, TheNumberOfDigitsTellsTheUnit) {
  EXPECT_EQ(parse_unix_time("1724479779")->ns, 1'724'479'779'000'000'000);
  EXPECT_EQ(parse_unix_time("1724479779384")->ns, 1'724'479'779'384'000'000);
  EXPECT_EQ(parse_unix_time("1724479779384729")->ns, 1'724'479'779'384'729'000);
  EXPECT_EQ(parse_unix_time("1724479779384729506")->ns, 1'724'479'779'384'729'506);
  for (const char* text : {"", "172447977", "17244797793", "-724479779", "1724479779.5", " 724479779", "1724479779x",
                           "9999999999999999", "9999999999999999999", "17244797793847295060"}) {
    EXPECT_FALSE(parse_unix_time(text)) << text;
  }
}

TEST(Stamp, ParsesExponentsByShiftingThePoint) {
  EXPECT_EQ(parse_seconds("1.724479779384729506e+09")->ns, 1724479779384729506);
  EXPECT_EQ(parse_seconds("1e-9")->ns, 1);
  EXPECT_EQ(parse_seconds("25E-3")->ns, 25'000'000);
}

TEST(Stamp, RoundsBeyondTheNanosecond) {
  EXPECT_EQ(parse_seconds("0.0000000004")->ns, 0);
  EXPECT_EQ(parse_seconds("0.0000000005")->ns, 1);
  EXPECT_EQ(parse_seconds("-0.9999999996")->ns, -1'000'000'000);
}

TEST(Stamp, RefusesWhatIsNotANumber) {
  for (const char* text : {"", "-", ".", "1.2.3", "1,5", "nan", "inf", "1e", "1e9999", "12s", " 1", "0x10"}) {
    EXPECT_FALSE(parse_seconds(text)) << text;
  }
  EXPECT_FALSE(parse_seconds("99999999999")) << "beyond 64-bit nanoseconds";
}

TEST(Stamp, FormatsSoThatParsingGivesTheSameStamp) {
  EXPECT_EQ(format_seconds({1724479779384729506}), "1724479779.384729506");
  EXPECT_EQ(format_seconds({-500'000'000}), "-0.500000000");
  EXPECT_EQ(format_seconds({7}), "0.000000007");
  for (const std::int64_t ns : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{83'333'333},
                                std::int64_t{1'724'479'779'384'729'506}, std::int64_t{9'000'000'000'000'000'000}}) {
    EXPECT_EQ(parse_seconds(format_seconds({ns}))->ns, ns);
  }
  EXPECT_EQ(format_seconds({std::numeric_limits<std::int64_t>::min()}), "-9223372036.854775808");
}

TEST(Stamp, DifferencesAreFormedInIntegers) {
  EXPECT_EQ(seconds_between({1724479779384729506}, {1724479779384729507}), 1e-9);
  EXPECT_EQ(seconds_between({2'000'000'000}, {500'000'000}), -1.5);
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_NEAR(seconds_between({kFirst}, {kLast}), 1.8446744073709552e10, 1.0);
  EXPECT_NEAR(seconds_between({kLast}, {kFirst}), -1.8446744073709552e10, 1.0);
}

}  // namespace
}  // namespace dynamic_icp
