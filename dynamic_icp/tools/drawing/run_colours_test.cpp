// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/drawing/run_colours.hpp"

#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp::drawing {
namespace {

using Names = std::vector<std::string>;
using Colours = std::vector<std::size_t>;

TEST(RunColours, AMethodHasOneWhateverElseIsDrawn) {
  const std::size_t kiss = colours_of_runs({"kiss-icp"}).front();
  EXPECT_EQ(colours_of_runs({"dynamic-icp", "gicp", "kiss-icp"})[2], kiss);
  EXPECT_EQ(colours_of_runs({"something else", "kiss-icp, coarse"})[1], kiss);
  EXPECT_EQ(colours_of_runs({"kiss-icp, coarse", "kiss-icp"})[1], kiss) << "the method itself goes first";
  EXPECT_NE(colours_of_runs({"kiss-icp2", "gicp"})[0], kiss);
}

TEST(RunColours, AllAreDifferent) {
  const Names names = {"dynamic-icp",   "doppler-icp", "point-to-point", "point-to-plane",     "gicp",
                       "kiss-icp",      "no-planes",   "no-support",     "dynamic-icp, paper", "dynamic-icp, bare",
                       "kiss-icp, 0.5", "run3"};
  const Colours colours = colours_of_runs(names);
  EXPECT_EQ(std::set<std::size_t>(colours.begin(), colours.end()).size(), names.size());
}

TEST(RunColours, OtherNamesGoInOrder) {
  EXPECT_EQ(colours_of_runs({"total", "ego_motion", "registration"}), (Colours{0, 1, 2}));
  EXPECT_EQ(colours_of_runs({}), Colours{});
}

}  // namespace
}  // namespace dynamic_icp::drawing
