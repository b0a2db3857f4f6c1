// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/range_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "dynamic_icp/recording/diagnosis/scan_look.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kCell_deg = 1.0;
constexpr std::size_t kMinPointsInCell = 3;
constexpr double kMinSurfaceShare = 0.15;  // of the points must have neighbours; a 4D radar has a quarter
constexpr std::size_t kMinSurfacePoints = 300;
constexpr double kSurfaceQuantile = 0.8;  // of the points; the others lie on edges

// How far ranges scatter about the median of their cell, as a logarithm. In simulated scenes of all kinds and sensors
// it is at most 0.05 of spherical coordinates, and at least 0.22 of x, y, z.
constexpr double kSurface = 0.1;

}  // namespace

bool shows_surfaces(std::span<const Eigen::Vector3d> azimuth_elevation_range) {
  std::map<std::pair<int, int>, std::vector<double>> cells;
  std::size_t points = 0;
  for (const Eigen::Vector3d& point : azimuth_elevation_range) {
    if (point.allFinite() && point.z() > 0.0) {
      cells[{static_cast<int>(std::floor(point.x() / kCell_deg)), static_cast<int>(std::floor(point.y() / kCell_deg))}]
          .push_back(std::log(point.z()));
      ++points;
    }
  }
  std::vector<double> scatter;
  for (auto& [cell, logarithms] : cells) {
    if (logarithms.size() < kMinPointsInCell) {
      continue;
    }
    const double median = quantile(logarithms, 0.5);
    std::transform(logarithms.begin(), logarithms.end(), std::back_inserter(scatter),
                   [&](double logarithm) { return std::abs(logarithm - median); });
  }
  const bool are_enough = scatter.size() >= kMinSurfacePoints &&
                          static_cast<double>(scatter.size()) >= kMinSurfaceShare * static_cast<double>(points);
  return are_enough && quantile(std::move(scatter), kSurfaceQuantile) < kSurface;
}

}  // namespace dynamic_icp::diagnosis
