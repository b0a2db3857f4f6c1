// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/paper.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/figures/series_plot.hpp"
#include "dynamic_icp/tools/figures/trajectory_plot.hpp"

#include "testing/picture_texts.hpp"
#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

using drawing::PixelBox;
using drawing::PlacedText;

bool overlap(const PixelBox& a, const PixelBox& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

/// Letters of 7 to 9 pt, all of them on the page, none over others; gives the document.
std::string check_on_paper(drawing::Svg svg) {
  svg.set_px_per_mm(kPaperPxPerMm);
  const std::string document = svg.document();
  EXPECT_NE(document.find("width=\"88mm\""), std::string::npos);
  const std::vector<PlacedText> texts = drawing::texts_of(document);
  EXPECT_GT(texts.size(), 5u);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    const auto& [text, size, box] = texts[k];
    const double points = size / kPaperPxPerMm / 25.4 * 72.0;
    EXPECT_TRUE(points > 7.0 && points < 9.05) << text << " " << points << " pt";
    EXPECT_TRUE(box.left >= 0.0 && box.top >= 0.0 && box.right() <= svg.width() && box.bottom() <= svg.height())
        << text;
    for (std::size_t other = 0; other < k; ++other) {
      EXPECT_FALSE(overlap(box, texts[other].box)) << text << " over " << texts[other].text;
    }
  }
  return document;
}

MapSize on_paper() { return {.width = kColumnWidth, .largest_height = 1.1 * kColumnWidth, .with_title = false}; }

/// A bend of 100 m; the offset grows along the way.
std::vector<Eigen::Vector3d> drive(double offset) {
  std::vector<Eigen::Vector3d> positions;
  for (int k = 0; k <= 200; ++k) {
    const double s = 0.005 * k;
    positions.emplace_back(100.0 * s, 30.0 * s * s + offset * s, 0.0);
  }
  return positions;
}

TEST(Paper, PathsFitAColumnAlsoWhereOneLeadsAway) {
  const drawing::Theme theme = drawing::theme(drawing::Ground::kLight);
  PathMap map{.estimates = {{"dynamic-icp", drive(0.1)}, {"doppler-icp", drive(2.0)}, {"gicp", drive(5.0)}},
              .ground_truth = drive(0.0)};
  const std::string without = check_on_paper(trajectory_plot(map, theme, on_paper()));
  const std::size_t lines = drawing::polylines_of(without).size();
  EXPECT_EQ(lines, 4u);
  map.estimates.push_back({"kiss-icp", drive(600.0)});
  const std::string with = check_on_paper(trajectory_plot(map, theme, on_paper()));
  EXPECT_EQ(drawing::polylines_of(with).size(), 2 * (lines + 1)) << "all of them in the inset as well";
  EXPECT_EQ(drawing::polylines_of(with)[1].back().x, drawing::polylines_of(without)[1].back().x)
      << "as large as without";
  EXPECT_NE(with.find("kiss-icp leaves the map"), std::string::npos);
}

TEST(Paper, PathsAllAroundHaveTheirInsetBelow) {
  const drawing::Theme theme = drawing::theme(drawing::Ground::kLight);
  std::vector<Eigen::Vector3d> round;
  for (int k = 0; k <= 200; ++k) {  // nearly a square
    const double angle = 0.01 * std::numbers::pi * k;
    round.emplace_back(50.0 * std::cbrt(std::cos(angle)), 50.0 * std::cbrt(std::sin(angle)), 0.0);
  }
  PathMap map{.estimates = {{"dynamic-icp", round}}, .ground_truth = round};
  const drawing::Svg without = trajectory_plot(map, theme, on_paper());
  map.estimates.push_back({"kiss-icp", drive(600.0)});
  const drawing::Svg with = trajectory_plot(map, theme, on_paper());
  check_on_paper(with);
  EXPECT_GT(with.height(), without.height() + 50.0);
}

TEST(Paper, PlotsOverTimeFitAColumn) {
  const drawing::Theme theme = drawing::theme(drawing::Ground::kLight);
  std::vector<double> times;
  Panel errors{.title = "Translation error", .label = "RTE (mm)", .series = {}, .levels = {{3.0, "expected mean"}}};
  for (const char* name : {"dynamic-icp", "doppler-icp", "gicp", "kiss-icp", "point-to-plane"}) {
    errors.series.push_back({name, {}});
  }
  for (int k = 0; k < 100; ++k) {
    times.push_back(0.1 * k);
    for (std::size_t i = 0; i < errors.series.size(); ++i) {
      errors.series[i].values.push_back(1.0 + static_cast<double>(i) + std::sin(0.2 * k));
    }
  }
  const std::string document = check_on_paper(
      series_plot(times, {errors, errors}, theme, {.width = kColumnWidth, .height = 120.0, .with_titles = false}));
  EXPECT_EQ(drawing::count_of(document, ">kiss-icp<"), 1u) << "one legend for both";
  EXPECT_EQ(drawing::count_of(document, ">time (s)<"), 1u);
}

}  // namespace
}  // namespace dynamic_icp::figures
