// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/svg.hpp"

#include <limits>
#include <random>
#include <regex>

#include <gtest/gtest.h>

#include "testing/well_formed.hpp"

namespace dynamic_icp::drawing {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The check itself must be able to fail.
TEST(WellFormed, FindsFaults) {
  EXPECT_EQ(WellFormed::fault_of("<a b=\"1\"><c/>x &amp; y</a>"), "");
  for (const char* text : {"", "<a>", "<a></b>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>&</a>", "<a>&nbsp;</a>",
                           "<a/><b/>", "x<a/>", "<a b=\"<\"/>", "<a>1 < 2</a>"}) {
    EXPECT_NE(WellFormed::fault_of(text), "") << text;
  }
  EXPECT_TRUE(holds_non_finite("x=\"nan\""));
  EXPECT_TRUE(holds_non_finite("1,2 -inf,3"));
  EXPECT_FALSE(holds_non_finite("information on nanoseconds"));
}

TEST(Svg, EveryElementIsWellFormed) {
  Svg svg(200.0, 100.0, "a <test> of \"everything\" & more");
  const std::vector<Pixel> corners = {{0.0, 0.0}, {10.0, 5.0}, {20.0, 0.0}};
  const Paint paint{.fill = "none", .stroke = "#000", .width = 2.0, .opacity = 0.5, .dash = "4 3", .title = "<&>'\""};
  svg.line({0.0, 0.0}, {1.0, 1.0}, paint);
  svg.polyline(corners, paint);
  svg.polygon(corners, paint);
  svg.rectangle({1.0, 2.0, 3.0, 4.0}, paint, 2.0);
  svg.circle({5.0, 5.0}, 2.0, paint);
  svg.arrow({0.0, 0.0}, {50.0, 0.0}, paint);
  svg.begin_clip({0.0, 0.0, 50.0, 50.0});
  svg.dots(corners, 2.0, "#123456");
  svg.end_clip();
  svg.text({3.0, 4.0}, "</text><script>",
           {.colour = "#000", .anchor = Anchor::kEnd, .bold = true, .vertical = true, .halo = "#fff"});
  EXPECT_EQ(WellFormed::fault_of(svg.document()), "");
  EXPECT_EQ(WellFormed::fault_of(svg.element()), "");
  EXPECT_EQ(svg.document().find("<script"), std::string::npos);
}

TEST(Svg, EmptyPictureIsWellFormed) { EXPECT_EQ(WellFormed::fault_of(Svg(10.0, 10.0, "").document()), ""); }

TEST(Svg, LeavesOutWhatIsNotFinite) {
  Svg svg(200.0, 100.0, "");
  const std::string empty = svg.document();
  const Paint paint{.fill = "#000", .stroke = "#000"};
  for (const double bad : {kNotANumber, kInfinity, -kInfinity}) {
    const std::vector<Pixel> corners = {{0.0, bad}, {bad, 1.0}};
    svg.line({0.0, bad}, {1.0, 1.0}, paint);
    svg.polyline(corners, paint);
    svg.polygon(corners, paint);
    svg.rectangle({1.0, 2.0, bad, 4.0}, paint);
    svg.circle({5.0, bad}, 2.0, paint);
    svg.circle({5.0, 5.0}, bad, paint);
    svg.arrow({0.0, 0.0}, {bad, 0.0}, paint);
    svg.dots(corners, 2.0, "#123456");
    svg.text({bad, 4.0}, "text", {.colour = "#000"});
  }
  EXPECT_EQ(svg.document(), empty);
}

TEST(Svg, LinesBreakAtGaps) {
  Svg svg(200.0, 100.0, "");
  const std::vector<Pixel> pixels = {{0.0, 0.0},         {1.0, 1.0}, {2.0, kNotANumber}, {3.0, 3.0},
                                     {4.0, kNotANumber}, {5.0, 5.0}, {6.0, 6.0}};
  svg.polyline(pixels, {.stroke = "#000"});
  EXPECT_EQ(count_of(svg.document(), "<polyline"), 2u);
  EXPECT_EQ(count_of(svg.document(), "<circle"), 1u) << "a point alone between gaps stays visible";
}

TEST(Svg, DotsStandWhereTheyWerePut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-300.0, 900.0);
  std::vector<Pixel> centres;
  for (int k = 0; k < 500; ++k) {
    centres.push_back({place(random), place(random)});
  }
  Svg svg(10.0, 10.0, "");
  svg.dots(centres, 2.0, "#000");
  const std::string document = svg.document();
  const std::regex move("m(-?[0-9]+) ?(-?[0-9]+)h0");
  double x = 0.0;
  double y = 0.0;
  std::size_t k = 0;
  for (std::sregex_iterator it(document.begin(), document.end(), move), end; it != end; ++it, ++k) {
    x += std::stod((*it)[1]) / 10.0;
    y += std::stod((*it)[2]) / 10.0;
    ASSERT_LT(k, centres.size());
    EXPECT_NEAR(x, centres[k].x, 0.0501);
    EXPECT_NEAR(y, centres[k].y, 0.0501) << "rounding must not add up over relative moves";
  }
  EXPECT_EQ(k, centres.size());
}

TEST(Svg, ArrowsPointWhereTheyShould) {
  Svg svg(100.0, 100.0, "");
  svg.arrow({10.0, 50.0}, {90.0, 50.0}, {.stroke = "#000", .width = 2.0});
  EXPECT_NE(svg.document().find("points=\"90,50 "), std::string::npos);
  Svg none(100.0, 100.0, "");
  none.arrow({10.0, 50.0}, {10.0, 50.0}, {.stroke = "#000"});
  EXPECT_EQ(count_of(none.document(), "<polygon"), 0u) << "no motion, no direction";
}

TEST(Svg, WidthCountsCharactersNotBytes) {
  EXPECT_EQ(estimated_width("äöü·", 10.0), estimated_width("abcd", 10.0));
  EXPECT_EQ(estimated_width("", 10.0), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::drawing
