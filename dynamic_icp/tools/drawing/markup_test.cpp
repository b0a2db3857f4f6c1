// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/markup.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::drawing {
namespace {

TEST(Markup, EscapesTheCharactersOfMarkup) {
  EXPECT_EQ(escape_markup(""), "");
  EXPECT_EQ(escape_markup("plain text, 100 %"), "plain text, 100 %");
  EXPECT_EQ(escape_markup("<script>alert(\"1\")</script>"), "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;");
  EXPECT_EQ(escape_markup("a & b's"), "a &amp; b&#39;s");
  EXPECT_EQ(escape_markup("&lt;"), "&amp;lt;");
}

TEST(Markup, KeepsTextOfEveryLanguage) {
  for (const char* text : {"Straße", "° ·", "道路", "🚗", "\t\n"}) {
    EXPECT_EQ(escape_markup(text), text);
  }
}

TEST(Markup, ReplacesWhatIsNoText) {
  const std::string replacement = "\xEF\xBF\xBD";
  EXPECT_EQ(escape_markup(std::string("a\0b", 3)), "a" + replacement + "b");
  EXPECT_EQ(escape_markup("\x1B[31m"), replacement + "[31m");
  EXPECT_EQ(escape_markup("\xE4"), replacement) << "Latin-1, cut off";
  EXPECT_EQ(escape_markup("\xC0\xBC"), replacement + replacement) << "an overlong '<'";
  EXPECT_EQ(escape_markup("\xED\xA0\x80"), replacement + replacement + replacement) << "half a surrogate pair";
  EXPECT_EQ(escape_markup("\xF4\x90\x80\x80"), replacement + replacement + replacement + replacement)
      << "beyond Unicode";
  EXPECT_EQ(escape_markup("\xC3<"), replacement + "&lt;") << "a cut character must not swallow the next one";
}

TEST(Markup, NumbersAreCompact) {
  EXPECT_EQ(compact_number(12.5), "12.5");
  EXPECT_EQ(compact_number(-3.0), "-3");
  EXPECT_EQ(compact_number(100.0), "100");
  EXPECT_EQ(compact_number(100.0, 0), "100");
  EXPECT_EQ(compact_number(0.125, 2), "0.12");
  EXPECT_EQ(compact_number(-0.001), "0");
  EXPECT_EQ(compact_number(1e-12, 9), "0");
  EXPECT_EQ(compact_number(1234567.0), "1234567");
}

TEST(Markup, NumbersAreNeverNonFinite) {
  EXPECT_EQ(compact_number(std::numeric_limits<double>::quiet_NaN()), "0");
  EXPECT_EQ(compact_number(std::numeric_limits<double>::infinity()), "0");
  EXPECT_EQ(compact_number(-std::numeric_limits<double>::infinity()), "0");
}

}  // namespace
}  // namespace dynamic_icp::drawing
