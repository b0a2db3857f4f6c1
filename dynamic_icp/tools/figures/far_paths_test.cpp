// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/far_paths.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::figures {
namespace {

using drawing::Pixel;
using drawing::PixelBox;
using Path = std::vector<Eigen::Vector3d>;

/// From the origin to the end in a hundred steps.
Path straight(double x, double y) {
  Path path;
  for (int k = 0; k <= 100; ++k) {
    path.emplace_back(0.01 * k * x, 0.01 * k * y, 0.0);
  }
  return path;
}

TEST(FarPaths, OneThatWouldShrinkTheRestIsLeftOut) {
  const Path truth = straight(100.0, 20.0);
  const MapChoice choice =
      choose_map({straight(101.0, 21.0), straight(100.0, 700.0), straight(0.0, 0.0)}, truth, 500, 400);
  EXPECT_EQ(choice.leads_away, (std::vector<bool>{false, true, false}));
  EXPECT_TRUE(choice.leaves_out());
  EXPECT_DOUBLE_EQ(choice.shown.x.maximum, 101.0);
  EXPECT_DOUBLE_EQ(choice.shown.y.maximum, 21.0);
  EXPECT_DOUBLE_EQ(choice.all.y.maximum, 700.0);
}

TEST(FarPaths, WhatCostsNoSizeIsShown) {
  // Sideways there is room: 60 m across a drive of 100 m shrink nothing in an area as high as wide.
  EXPECT_FALSE(choose_map({straight(100.0, 60.0)}, straight(100.0, 0.0), 400, 400).leaves_out());
  EXPECT_TRUE(choose_map({straight(100.0, 160.0)}, straight(100.0, 0.0), 400, 400).leaves_out());
}

TEST(FarPaths, WithoutGroundTruthTheMedianIsWhatOthersAreComparedWith) {
  const MapChoice choice = choose_map({straight(100, 0), straight(110, 0), straight(2000, 0)}, {}, 400, 400);
  EXPECT_EQ(choice.leads_away, (std::vector<bool>{false, false, true}));
  EXPECT_FALSE(choose_map({straight(100, 0), straight(2000, 0)}, {}, 400, 400).leaves_out()) << "who is right?";
}

TEST(FarPaths, NothingAndNumbersThatAreNoneAreTaken) {
  EXPECT_FALSE(choose_map({}, {}, 400, 400).leaves_out());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MapChoice choice = choose_map({{{nan, nan, nan}}, {{1.0, 2.0, nan}}}, {}, 400, 400);
  EXPECT_EQ(choice.leads_away, (std::vector<bool>{false, false}));
  EXPECT_DOUBLE_EQ(choice.all.x.minimum, 1.0);
  EXPECT_FALSE(choose_map({straight(5.0, 0.0)}, {{0.0, 0.0, 0.0}}, 400, 400).leaves_out()) << "a truth at rest";
}

TEST(FarPaths, ALineLeavesABoxOnItsEdge) {
  const PixelBox box{0.0, 0.0, 100.0, 50.0};
  const std::vector<Pixel> line = {{50.0, 25.0}, {60.0, 25.0}, {60.0, 75.0}, {60.0, 25.0}, {160.0, 25.0}};
  const auto exit = exit_of(line, box);
  ASSERT_TRUE(exit);
  EXPECT_DOUBLE_EQ(exit->x, 60.0);
  EXPECT_DOUBLE_EQ(exit->y, 50.0);
  EXPECT_FALSE(exit_of(std::vector<Pixel>{{1.0, 1.0}, {99.0, 49.0}}, box));
  EXPECT_FALSE(exit_of(std::vector<Pixel>{{200.0, 1.0}, {300.0, 49.0}}, box));
}

TEST(FarPaths, AFreeCornerIsOneThatNoLineCrosses) {
  const PixelBox area{0.0, 0.0, 300.0, 300.0};
  // Both ends of the line are outside of the corner at the top right: what crosses it is between them.
  const std::vector<std::vector<Pixel>> across = {{{150.0, -50.0}, {350.0, 150.0}}};
  const auto corner = free_corner(area, 100.0, 100.0, across);
  ASSERT_TRUE(corner);
  EXPECT_LT(corner->right(), 150.0) << "the left one";
  EXPECT_LT(corner->bottom(), 150.0) << "the upper one";
  const std::vector<std::vector<Pixel>> around = {{{20, 20}, {280, 20}, {280, 280}, {20, 280}, {20, 20}}};
  EXPECT_FALSE(free_corner(area, 100.0, 100.0, around));
  EXPECT_FALSE(free_corner(area, 400.0, 100.0, {})) << "larger than the area";
}

}  // namespace
}  // namespace dynamic_icp::figures
