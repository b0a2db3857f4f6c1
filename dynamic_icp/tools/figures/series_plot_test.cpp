// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/series_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string drawn(const std::vector<double>& times, const std::vector<Panel>& panels) {
  const std::string document = series_plot(times, panels, drawing::theme(drawing::Ground::kLight)).document();
  EXPECT_EQ(drawing::WellFormed::fault_of(document), "");
  EXPECT_FALSE(drawing::holds_non_finite(document));
  return document;
}

Panel panel(std::vector<double> values) { return {.title = "t", .label = "l", .series = {{"a", std::move(values)}}}; }

/// The smallest y (the highest point) of all lines.
double highest_pixel(const std::string& document) {
  double highest = 1e9;
  for (const std::vector<drawing::Pixel>& line : drawing::polylines_of(document)) {
    for (const drawing::Pixel& pixel : line) {
      highest = std::min(highest, pixel.y);
    }
  }
  return highest;
}

TEST(SeriesPlot, DrawsNothingAndLittle) {
  drawn({}, {});
  EXPECT_NE(drawn({}, {panel({})}).find("no values"), std::string::npos);
  EXPECT_NE(drawn({0.0, 1.0}, {panel({kNotANumber, kNotANumber})}).find("no values"), std::string::npos);
  EXPECT_EQ(drawing::count_of(drawn({5.0}, {panel({3.0})}), "<circle"), 1u) << "a single frame is a dot";
  drawn({0.0, 1.0}, {panel({0.0, 0.0})});
  drawn({0.0, 1.0}, {panel({1e300, -1e300})});
  drawn({0.0, 0.0}, {panel({1.0, 2.0})});
}

TEST(SeriesPlot, LogarithmicScaleTakesZerosAndNegatives) {
  for (const std::vector<double>& values :
       {std::vector<double>{0.0, 0.0}, {0.0, 1.0}, {-1.0, kNotANumber}, {1e-12, 1e12}, {3.0, 3.0}}) {
    Panel logarithmic = panel(values);
    logarithmic.logarithmic = true;
    drawn({0.0, 1.0}, {logarithmic});
  }
}

TEST(SeriesPlot, GapsBreakTheLine) {
  const std::string document = drawn({0.0, 1.0, 2.0, 3.0, 4.0}, {panel({1.0, 2.0, kNotANumber, 2.0, 1.0})});
  EXPECT_EQ(drawing::count_of(document, "<polyline"), 2u);
}

TEST(SeriesPlot, LongDrivesStaySmallAndKeepTheirPeaks) {
  std::vector<double> times;
  std::vector<double> values;
  for (int k = 0; k < 200'000; ++k) {
    times.push_back(0.1 * k);
    values.push_back(1.0 + 0.5 * std::sin(0.7 * k));
  }
  values[123'456] = 9.0;
  const std::string document = drawn(times, {panel(values)});
  EXPECT_LT(document.size(), 120'000u);
  // The axis ends 8 % above the peak: the peak lies at 1 - 1 / 1.08 of the height below the top.
  const double top = 40.0;
  EXPECT_NEAR(highest_pixel(document), top + 210.0 * (1.0 - 1.0 / 1.08), 0.1);
}

TEST(SeriesPlot, SeveralLinesGetALegendOneDoesNot) {
  Panel two = panel({1.0, 2.0});
  EXPECT_EQ(drawn({0.0, 1.0}, {two}).find(">a<"), std::string::npos);
  two.series.push_back({"<b>", {2.0, 1.0}, true});
  const std::string document = drawn({0.0, 1.0}, {two});
  EXPECT_NE(document.find(">a<"), std::string::npos);
  EXPECT_NE(document.find(">&lt;b&gt;<"), std::string::npos);
}

TEST(SeriesPlot, NoLineRunsOverTheNameOfALevel) {
  Panel with_level = panel({1.0, 3.0, 1.0});
  with_level.levels = {{2.0, "expected"}};
  const std::string document = drawn({0.0, 1.0, 2.0}, {with_level});
  ASSERT_NE(document.find(">expected<"), std::string::npos);
  EXPECT_EQ(document.find("<polyline", document.find(">expected<")), std::string::npos) << "what comes later covers it";
}

TEST(SeriesPlot, DecadesAreSpannedByAFewTowers) {
  EXPECT_FALSE(spans_decades({}));
  EXPECT_FALSE(spans_decades({1.0, 2.0, 3.0, 4.0}));
  EXPECT_TRUE(spans_decades({1.0, 2.0, 3.0, 400.0}));
  EXPECT_FALSE(spans_decades({0.0, kNotANumber, 400.0}));
}

TEST(SeriesPlot, LinesLieFarApartByTheirMedians) {
  EXPECT_FALSE(lie_far_apart({}));
  EXPECT_FALSE(lie_far_apart({{"a", {1.0, 2.0, 500.0}}, {"b", {3.0, kNotANumber, 4.0}}})) << "one tower is no far line";
  EXPECT_TRUE(lie_far_apart({{"a", {0.01, 0.02, 0.0}}, {"b", {1.0, 1.0, 1.0}}}));
  EXPECT_FALSE(lie_far_apart({{"a", {0.0, kNotANumber}}, {"b", {1.0, 1.0}}})) << "no axis shows the first";
}

}  // namespace
}  // namespace dynamic_icp::figures
