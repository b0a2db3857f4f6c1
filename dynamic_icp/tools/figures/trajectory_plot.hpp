// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"

namespace dynamic_icp::figures {

struct NamedPath {
  std::string name;
  std::vector<Eigen::Vector3d> positions;  ///< m
};

/// The paths of a map, all in one world frame (m).
struct PathMap {
  std::vector<NamedPath> estimates = {};
  std::vector<Eigen::Vector3d> ground_truth = {};  ///< empty: none
  std::string title = "Trajectory from above";
};

struct MapSize {
  double width = 560.0;           ///< px
  double largest_height = 520.0;  ///< px; a straight drive gets less
  bool with_title = true;
};

/// Top view (x to the right, y up) with equal scales: the estimates as lines on top of a broad line for the
/// ground truth, a ring where the drive starts and a dot where each estimate ends. Without positions the map is empty
/// and says so. Estimates that lead so far away that the rest would be small are cut off at the edge, where a triangle
/// points out; all of them stand in an inset in a free corner, else below the map (see `choose_map`).
drawing::Svg trajectory_plot(const PathMap& paths, const drawing::Theme& theme, const MapSize& size = {});

}  // namespace dynamic_icp::figures
