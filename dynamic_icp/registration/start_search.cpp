// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamic_icp/registration/map_alignment.hpp"

namespace dynamic_icp::registration {
namespace {

// An alignment finds its way back from about this far.
constexpr double kStep_rad = 2.5 * std::numbers::pi / 180.0;

// Starts lie within so many deviations of the prior.
constexpr double kReach = 2.5;

constexpr double kCandidateGate_m = 2.0;
constexpr double kFinalGate_m = 0.5;

constexpr int kMostSteps = 6;
constexpr std::size_t kFewPoints = 1500;

Scan thinned(const Scan& scan) {
  const std::size_t stride = std::max<std::size_t>(1, scan.size() / kFewPoints);
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < scan.size(); row += stride) {
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  return scan.select(rows);
}

}  // namespace

MapAlignment search_and_align(const Scan& scan, const mapping::PlaneMap& map, const MotionPrior& prior,
                              const MapAlignConfig& config, const Workers& workers) {
  const Scan few = thinned(scan);
  Eigen::Matrix3d best = prior.R_map_sensor;
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double deviation = std::sqrt(prior.covariance(axis, axis));
    const int steps = std::min(kMostSteps, static_cast<int>(kReach * deviation / kStep_rad));
    for (int k = -steps; k <= steps; ++k) {
      if (k == 0 && axis > 0) {
        continue;  // tried with the first axis
      }
      const Eigen::Matrix3d R_start = exp_so3(k * kStep_rad * Eigen::Vector3d::Unit(axis)) * prior.R_map_sensor;
      const MapAlignment candidate = align_to_map(few, map, prior, R_start, kCandidateGate_m, config, workers);
      if (candidate.matched > most) {
        most = candidate.matched;
        best = candidate.T_map_sensor.linear();
      }
    }
  }
  return align_to_map(scan, map, prior, best, kFinalGate_m, config, workers);
}

}  // namespace dynamic_icp::registration
