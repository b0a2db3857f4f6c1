// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/scan_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "testing/picture_texts.hpp"
#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string drawn(const ScanView& view) {
  const std::string document = scan_plot(view, drawing::theme(drawing::Ground::kDark)).document();
  EXPECT_EQ(drawing::WellFormed::fault_of(document), "");
  EXPECT_FALSE(drawing::holds_non_finite(document));
  return document;
}

ScanView random_view(int points) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> forward(1.0, 140.0);
  std::uniform_real_distribution<double> across(-60.0, 60.0);
  RawScan raw;
  for (int k = 0; k < points; ++k) {
    const Eigen::Vector3d p(forward(random), across(random), -1.0);
    raw.points.push_back(p);
    raw.doppler.push_back(-13.0 * p.normalized().x());
  }
  ScanView view;
  view.title = "Scan 7";
  view.scan = Scan::from_raw(raw);
  view.ego_velocity = {13.0, 0.0, 0.0};
  view.objects = {
      {.id = 4, .velocity = {-9.0, 0.0, 0.0}, .centroid = {40.0, 3.0, 0.0}, .extent = {4.0, 2.0, 1.5}, .points = 80}};
  return view;
}

TEST(ScanPlot, DrawsNothingAndLittle) {
  drawn({});
  ScanView view;
  view.objects = random_view(0).objects;
  drawn(view);
  drawn(random_view(1));
}

TEST(ScanPlot, NamesObjectsWithTheirSpeed) {
  const std::string document = drawn(random_view(2000));
  EXPECT_NE(document.find(">4 · 9.0 m/s<"), std::string::npos);
  EXPECT_NE(document.find(">sensor · 13.0 m/s<"), std::string::npos);
  EXPECT_NE(document.find("2,000 points"), std::string::npos);
  EXPECT_EQ(drawing::count_of(document, "Ego-motion compensated"), 1u);
}

TEST(ScanPlot, OnPaperAllTextsAreOnThePageAlsoWherePanelsStandSideBySide) {
  ScanView view = random_view(2000);
  view.objects.clear();  // their names are placed, and cut, within the panel
  const drawing::Svg svg = scan_plot(view, drawing::theme(drawing::Ground::kLight), Medium::kPaper);
  EXPECT_DOUBLE_EQ(svg.width(), kTextWidth);
  const std::string document = svg.document();
  double heads_right = 0.0;
  for (const auto& [text, size, box] : drawing::texts_of(document)) {
    EXPECT_TRUE(box.left >= 0.0 && box.right() <= svg.width() && box.bottom() <= svg.height()) << text;
    EXPECT_GE(size / kPaperPxPerMm / 25.4 * 72.0, 7.0) << text;
    if (text.starts_with("Measured") || text.starts_with("every point")) {
      heads_right = std::max(heads_right, box.right());
    } else if (text.starts_with("Ego-motion")) {
      EXPECT_LT(heads_right, box.left) << "heads side by side";
    }
  }
}

TEST(ScanPlot, TheLabelOfTheSensorHasTheColourOfItsMark) {
  const std::string document = drawn(random_view(2000));
  const auto fill_before = [&](const std::string& end) {
    const std::size_t fill = document.rfind("fill=\"", document.find(end)) + 6;
    return document.substr(fill, document.find('"', fill) - fill);
  };
  EXPECT_EQ(fill_before(">sensor · "), fill_before("<title>sensor</title>"));
  EXPECT_NE(fill_before(">sensor · "), fill_before(">4 · "));
}

TEST(ScanPlot, WithoutEgoVelocityThereIsOnePanel) {
  ScanView view = random_view(2000);
  view.ego_velocity.setConstant(kNaN);
  const std::string document = drawn(view);
  EXPECT_EQ(document.find("Ego-motion compensated"), std::string::npos);
  EXPECT_NE(document.find(">4 · 9.0 m/s<"), std::string::npos) << "objects are still named";
}

TEST(ScanPlot, StaticSceneIsGreyOnceOwnMotionIsTakenOut) {
  const std::string document = drawn(random_view(2000));
  const std::string lower = document.substr(document.find("Ego-motion compensated"));
  EXPECT_EQ(drawing::count_of(lower, "stroke-linecap=\"round\" d="), 1u) << "one path of dots, of one colour";
  const std::string grey =
      drawing::theme(drawing::Ground::kDark).doppler[drawing::theme(drawing::Ground::kDark).doppler.size() / 2];
  EXPECT_NE(lower.find("stroke=\"" + grey + "\" stroke-width=\"21\""), std::string::npos);
}

TEST(ScanPlot, TakesValuesThatAreNotFinite) {
  ScanView view = random_view(100);
  for (const double bad : {kNaN, 1e300, -1e300}) {
    runs::ObjectRow object = view.objects.front();
    object.velocity.setConstant(bad);
    view.objects.push_back(object);
    object.centroid.setConstant(bad);
    view.objects.push_back(object);
    object = view.objects.front();
    object.extent.setConstant(bad);
    view.objects.push_back(object);
  }
  drawn(view);
}

TEST(ScanPlot, StaysUnder300KilobytesForAnyScan) { EXPECT_LT(drawn(random_view(150'000)).size(), 300'000u); }

TEST(ScanPlot, TitlesAreEscaped) {
  ScanView view = random_view(10);
  view.title = "<script>\"&";
  EXPECT_EQ(drawn(view).find("<script"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::figures
