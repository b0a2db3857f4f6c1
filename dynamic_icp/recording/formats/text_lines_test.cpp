// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/text_lines.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::formats {
namespace {

using Words = std::vector<std::string_view>;

TEST(TextLines, LinesNeedNoEnd) {
  std::string_view rest = "one\n\nthree";
  EXPECT_EQ(take_line(rest), "one");
  EXPECT_EQ(take_line(rest), "");
  EXPECT_EQ(take_line(rest), "three");
  EXPECT_FALSE(take_line(rest));
  std::string_view ended = "one\n";
  EXPECT_EQ(take_line(ended), "one");
  EXPECT_FALSE(take_line(ended));
}

TEST(TextLines, WordsStandBetweenBlanks) {
  EXPECT_EQ(words_of(""), Words{});
  EXPECT_EQ(words_of(" \t\r"), Words{});
  EXPECT_EQ(words_of("a"), Words{"a"});
  EXPECT_EQ(words_of("  a bc\td \r"), (Words{"a", "bc", "d"}));
}

TEST(QuotedText, IsShortAndPrintable) {
  EXPECT_EQ(quoted_text("ab c"), "'ab c'");
  EXPECT_EQ(quoted_text("a\xE9\n"),
            "'a?"
            "?'");
  EXPECT_EQ(quoted_text(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace dynamic_icp::formats
