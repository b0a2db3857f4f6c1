// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/tools/drawing/axes.hpp"

// Estimates that lead far away from the others: a map that held all of them would show the rest as a dot.
namespace dynamic_icp::figures {

/// A part of the plane, m.
struct MapRegion {
  drawing::Range x;
  drawing::Range y;
};

/// The smallest region with all finite positions of the paths; none without any.
std::optional<MapRegion> region_of(std::span<const std::vector<Eigen::Vector3d>* const> paths);

/// What a map of `width` x `height` px (at most) shows.
struct MapChoice {
  MapRegion shown;               ///< without room around it
  MapRegion all;                 ///< the region of all paths
  std::vector<bool> leads_away;  ///< per estimate: it is cut off where it leaves the map

  [[nodiscard]] bool leaves_out() const;
};

/// The ground truth and those estimates which do not shrink it: with one of them alone a metre would be more than 1.5
/// times smaller. Without ground truth the median estimate is what the others are compared with.
MapChoice choose_map(const std::vector<std::vector<Eigen::Vector3d>>& estimates,
                     const std::vector<Eigen::Vector3d>& ground_truth, double width, double height);

/// The first place where a line leaves a box: on its edge, on the way from the last pixel inside to the first one
/// outside. None where it stays, or is never inside.
std::optional<drawing::Pixel> exit_of(std::span<const drawing::Pixel> line, const drawing::PixelBox& box);

/// A corner of the area where a box of this size covers none of the lines; none where all four are taken.
std::optional<drawing::PixelBox> free_corner(const drawing::PixelBox& area, double width, double height,
                                             std::span<const std::vector<drawing::Pixel>> lines);

}  // namespace dynamic_icp::figures
