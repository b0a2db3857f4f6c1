// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/range_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
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
constexpr double kContrary = 0.15;  // beyond doubt

// The same of radians taken for x, y, z: of simulated scans of LiDARs 0.05 to 0.21 and 2.7 to 15 times as much as of
// the angles; of x, y, z where they may be angles at all at most 0.05, and less than of these angles.
constexpr double kNoSurface = 0.07;
constexpr double kTimesLess = 2.0;
constexpr double kFar_m = 20.0;  // no room is as long and as narrow as angles are small
constexpr double kFarQuantile = 0.95;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// How far ranges scatter about the median of those in neighbouring directions: the quantile of the logarithms. Angles
/// are in degrees. Nothing where so few points lie close to each other that it does not show.
std::optional<double> range_scatter(std::span<const Eigen::Vector3d> azimuth_elevation_range) {
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
  return are_enough ? std::optional(quantile(std::move(scatter), kSurfaceQuantile)) : std::nullopt;
}

/// Azimuth and elevation, in degrees, and range.
Eigen::Vector3d direction_of(const Eigen::Vector3d& point) {
  return {kDegrees * std::atan2(point.y(), point.x()), kDegrees * std::atan2(point.z(), point.head<2>().norm()),
          point.norm()};
}

}  // namespace

bool shows_surfaces(std::span<const Eigen::Vector3d> azimuth_elevation_range) {
  return range_scatter(azimuth_elevation_range).value_or(kSurface) < kSurface;
}

bool contradicts_surfaces(std::span<const Eigen::Vector3d> azimuth_elevation_range) {
  return range_scatter(azimuth_elevation_range).value_or(0.0) > kContrary;
}

bool are_radians_with_ranges(std::span<const Eigen::Vector3d> azimuth_elevation_range,
                             std::span<const Eigen::Vector3d> as_stored) {
  std::vector<Eigen::Vector3d> degrees;
  std::vector<double> ranges;
  for (const Eigen::Vector3d& point : azimuth_elevation_range) {
    if (point.allFinite()) {
      degrees.emplace_back(kDegrees * point.x(), kDegrees * point.y(), point.z());
      ranges.push_back(point.z());
    }
  }
  if (ranges.empty() || quantile(std::move(ranges), kFarQuantile) < kFar_m) {
    return false;
  }
  std::vector<Eigen::Vector3d> directions;
  std::transform(as_stored.begin(), as_stored.end(), std::back_inserter(directions), direction_of);
  const double of_angles = range_scatter(degrees).value_or(kSurface);
  const double of_metres = range_scatter(directions).value_or(0.0);
  return of_angles < kSurface && of_metres > kNoSurface && of_metres > kTimesLess * of_angles;
}

}  // namespace dynamic_icp::diagnosis
