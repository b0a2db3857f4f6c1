// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/rotation_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace dynamic_icp::mapping {
namespace {

// An alignment finds its way back from about this far.
constexpr double kStep_rad = 2.5 * std::numbers::pi / 180.0;

// Starts lie within so many standard deviations of the prior.
constexpr double kReach = 2.5;

constexpr double kCandidateGate_m = 2.0;
constexpr double kFinalGate_m = 0.5;

// After these the kernel of a candidate is narrow: enough to compare.
constexpr int kCandidateSteps = 9;

constexpr int kMaxSteps = 6;
constexpr std::size_t kFewPoints = 1500;

Scan thinned(const Scan& scan) {
  const std::size_t stride = std::max<std::size_t>(1, scan.size() / kFewPoints);
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < scan.size(); row += stride) {
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  return scan.select(rows);
}

/// The rotation of the prior, and those turned from it about each axis.
std::vector<Eigen::Matrix3d> starts_around(const MotionPrior& prior) {
  std::vector<Eigen::Matrix3d> starts = {prior.R_map_sensor};
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = std::sqrt(prior.covariance(axis, axis));
    const int steps = static_cast<int>(std::min<double>(kMaxSteps, kReach * sigma / kStep_rad));
    for (int k = -steps; k <= steps; ++k) {
      if (k != 0) {
        starts.emplace_back(exp_so3(k * kStep_rad * Eigen::Vector3d::Unit(axis)) * prior.R_map_sensor);
      }
    }
  }
  return starts;
}

}  // namespace

MapAlignment search_and_align(const Scan& scan, const PlaneMap& map, const MotionPrior& prior,
                              const MapAlignConfig& config, const Workers& workers) {
  const Scan few = thinned(scan);
  const std::vector<Eigen::Matrix3d> starts = starts_around(prior);
  MapAlignConfig quick = config;
  quick.max_iterations = std::min(config.max_iterations, kCandidateSteps);
  std::vector<MapAlignment> candidates(starts.size());
  workers.for_each(starts.size(), 1, [&](std::size_t k) {
    candidates[k] = align_to_map(few, map, prior, starts[k], kCandidateGate_m, quick, workers);
  });
  Eigen::Matrix3d best = prior.R_map_sensor;
  double most = 0.0;
  for (const MapAlignment& candidate : candidates) {
    if (candidate.matched > most) {
      most = candidate.matched;
      best = candidate.T_map_sensor.linear();
    }
  }
  return align_to_map(scan, map, prior, best, kFinalGate_m, config, workers);
}

}  // namespace dynamic_icp::mapping
