// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/trajectory_plot.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

std::string drawn_paths(const PathMap& paths) {
  const std::string document = trajectory_plot(paths, drawing::theme(drawing::Ground::kDark)).document();
  EXPECT_EQ(drawing::WellFormed::fault_of(document), "");
  EXPECT_FALSE(drawing::holds_non_finite(document));
  return document;
}

TEST(TrajectoryPlot, DrawsNothingAndLittle) {
  EXPECT_NE(drawn_paths({}).find("no poses"), std::string::npos);
  drawn_paths({.estimates = {{"estimate", {{1.0, 2.0, 3.0}}}}});
  drawn_paths({.estimates = {{"estimate", {{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}}}});
  drawn_paths({.estimates = {{"estimate", {}}}, .ground_truth = {{1.0, 2.0, 3.0}, {4.0, 2.0, 3.0}}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  drawn_paths({.estimates = {{"estimate", {{1.0, 2.0, 3.0}, {nan, nan, nan}, {2.0, 2.0, 3.0}}}}});
}

TEST(TrajectoryPlot, SquareStaysASquareAndYPointsUp) {
  const std::vector<drawing::Pixel> line =
      drawing::polylines_of(
          drawn_paths({.estimates = {{"estimate", {{0, 0, 0}, {30, 0, 0}, {30, 30, 0}, {0, 30, 0}}}}}))
          .back();
  ASSERT_EQ(line.size(), 4u);
  const double side = line[1].x - line[0].x;
  EXPECT_GT(side, 100.0);
  EXPECT_NEAR(line[1].y, line[0].y, 0.02);
  EXPECT_NEAR(line[1].y - line[2].y, side, 0.02);
}

TEST(TrajectoryPlot, LongDrivesStaySmall) {
  PathMap paths{.estimates = {{"estimate", {}}}};
  for (int k = 0; k < 100'000; ++k) {
    paths.estimates[0].positions.emplace_back(0.1 * k, 5.0 * std::sin(0.001 * k), 0.0);
  }
  const std::string document = drawn_paths(paths);
  EXPECT_LT(document.size(), 60'000u);
  const std::vector<drawing::Pixel> line = drawing::polylines_of(document).back();
  EXPECT_NEAR(line.back().x - line.front().x, 468.0 / 1.1, 1.0) << "the end is drawn";
}

TEST(TrajectoryPlot, NamesGroundTruthOnlyWhereThereIsOne) {
  PathMap paths{.estimates = {{"estimate", {{0, 0, 0}, {1, 0, 0}}}}};
  EXPECT_EQ(drawn_paths(paths).find("ground truth"), std::string::npos);
  paths.ground_truth = paths.estimates[0].positions;
  EXPECT_NE(drawn_paths(paths).find("ground truth"), std::string::npos);
}

TEST(TrajectoryPlot, TellsSeveralEstimatesApart) {
  PathMap paths;
  for (int k = 0; k < 12; ++k) {
    paths.estimates.push_back({"path <" + std::to_string(k) + ">", {{0, 0, 0}, {10, 1.0 * k, 0}}});
  }
  paths.ground_truth = {{0, 0, 0}, {10, 0, 0}};
  const std::string document = drawn_paths(paths);
  EXPECT_EQ(drawing::polylines_of(document).size(), 13u);
  for (int k = 0; k < 12; ++k) {
    EXPECT_NE(document.find("path &lt;" + std::to_string(k) + "&gt;"), std::string::npos);
  }
}

}  // namespace
}  // namespace dynamic_icp::figures
