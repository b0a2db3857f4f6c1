// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/axes.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "testing/well_formed.hpp"

namespace dynamic_icp::drawing {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Range, LeavesOutWhatIsNotFinite) {
  EXPECT_FALSE(range_of({}));
  EXPECT_FALSE(range_of(std::vector<double>{kNaN}));
  const std::optional<Range> range = range_of(std::vector<double>{3.0, kNaN, -1.0, INFINITY});
  EXPECT_EQ(range->minimum, -1.0);
  EXPECT_EQ(range->maximum, 3.0);
}

TEST(Range, PaddingGivesLengthToASingleValue) {
  for (const double value : {0.0, 1.0, -1e6, 1e-9, 1e12}) {
    const Range range = padded({value, value}, 0.1);
    EXPECT_GT(range.length(), 0.0);
    EXPECT_LT(range.minimum, value);
    EXPECT_GT(range.maximum, value);
    EXPECT_FALSE(nice_ticks(range, 5).empty()) << value;
  }
  EXPECT_NEAR(padded({0.0, 10.0}, 0.1).maximum, 11.0, 1e-12);
}

TEST(Ticks, StepsAreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(nice_step(10.0, 5), 2.0);
  EXPECT_DOUBLE_EQ(nice_step(10.0, 10), 1.0);
  EXPECT_DOUBLE_EQ(nice_step(10.0, 4), 5.0);
  EXPECT_DOUBLE_EQ(nice_step(0.03, 5), 0.01);
  EXPECT_DOUBLE_EQ(nice_step(7000.0, 3), 5000.0);
  EXPECT_DOUBLE_EQ(nice_step(1.0, 1), 1.0);
}

TEST(Ticks, AreFewRoundAndInside) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  std::uniform_real_distribution<double> offset(-3.0, 3.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const double length = std::pow(10.0, exponent(random));
    const double start = offset(random) * length;
    const Range range{start, start + length};
    const int most = 1 + trial % 12;
    const std::vector<double> ticks = nice_ticks(range, most);
    const double step = nice_step(length, most);
    EXPECT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
    EXPECT_GE(ticks.size(), static_cast<std::size_t>(std::floor(length / step)));
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    EXPECT_LT(std::min({std::abs(mantissa - 1.0), std::abs(mantissa - 2.0), std::abs(mantissa - 5.0)}), 1e-6) << step;
    for (const double tick : ticks) {
      EXPECT_NEAR(tick / step, std::round(tick / step), 1e-6);
      EXPECT_GE(tick, range.minimum - 1e-5 * step);
      EXPECT_LE(tick, range.maximum + 1e-5 * step);
    }
  }
}

TEST(Ticks, NoRangeNoTicks) {
  EXPECT_TRUE(nice_ticks({1.0, 1.0}, 5).empty());
  EXPECT_TRUE(nice_ticks({0.0, kNaN}, 5).empty());
  EXPECT_TRUE(nice_ticks({0.0, INFINITY}, 5).empty());
}

TEST(Ticks, LogarithmicOnesArePowersOfTen) {
  EXPECT_EQ(log_ticks({0.5, 2000.0}), (std::vector<double>{1.0, 10.0, 100.0, 1000.0}));
  const std::vector<double> fine = log_ticks({1.5, 60.0});
  ASSERT_EQ(fine.size(), 5u);
  EXPECT_DOUBLE_EQ(fine[0], 2.0);
  EXPECT_DOUBLE_EQ(fine[4], 50.0);
}

TEST(Axes, MapsCornersToCorners) {
  const PixelBox area{50.0, 20.0, 400.0, 200.0};
  const Axes axes(area, {.label = "x", .range = {-1.0, 3.0}},
                  {.label = "y", .range = {0.01, 100.0}, .scale = Scale::kLogarithmic});
  EXPECT_NEAR(axes.at(-1.0, 0.01).x, 50.0, 1e-9);
  EXPECT_NEAR(axes.at(-1.0, 0.01).y, 220.0, 1e-9);
  EXPECT_NEAR(axes.at(3.0, 100.0).x, 450.0, 1e-9);
  EXPECT_NEAR(axes.at(3.0, 100.0).y, 20.0, 1e-9);
  EXPECT_NEAR(axes.at(1.0, 1.0).y, 120.0, 1e-9) << "one is the geometric mean of the range";
}

TEST(Axes, EqualAspectOnlyWidens) {
  const PixelBox area{0.0, 0.0, 300.0, 100.0};
  Range x{0.0, 10.0};
  Range y{5.0, 25.0};
  make_aspect_equal(area, x, y);
  EXPECT_NEAR(x.length() / area.width, y.length() / area.height, 1e-12);
  EXPECT_LE(x.minimum, 0.0);
  EXPECT_GE(x.maximum, 10.0);
  EXPECT_NEAR(x.minimum + x.maximum, 10.0, 1e-9) << "the middle stays";
  EXPECT_NEAR(y.length(), 20.0, 1e-12);
}

TEST(Axes, CountsGetNoTicksInBetween) {
  Svg svg(500.0, 300.0, "");
  const Axes axes({80.0, 10.0, 400.0, 240.0}, {.label = "t", .range = {0.0, 1.0}},
                  {.label = "n", .range = {0.0, 2.2}, .whole_numbers = true});
  axes.draw(svg, theme(Ground::kLight));
  EXPECT_EQ(svg.document().find(">0.5<"), svg.document().rfind(">0.5<")) << "on the time axis only";
  EXPECT_NE(svg.document().find(">2<"), std::string::npos);
  EXPECT_EQ(WellFormed::fault_of(svg.document()), "");
}

TEST(Legend, WrapsWhereTheWidthEnds) {
  const Theme colours = theme(Ground::kLight);
  const std::vector<LegendEntry> entries(6, {"a name of some length", "#000000"});
  EXPECT_EQ(draw_legend(nullptr, colours, {}, 1e6, entries), 1);
  EXPECT_EQ(draw_legend(nullptr, colours, {}, 1.0, entries), 6);
  Svg svg(10.0, 10.0, "");
  EXPECT_EQ(draw_legend(&svg, colours, {}, 1.0, entries), 6);
  EXPECT_EQ(count_of(svg.document(), "<text"), 6u);
}

}  // namespace
}  // namespace dynamic_icp::drawing
