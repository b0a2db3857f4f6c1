// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/way_search.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kAlignedPoints = 700;
constexpr std::size_t kJudgedPoints = 4000;
constexpr double kStartStep_m = 0.8;
constexpr double kReach_m = 1.0;
constexpr double kWidth_m = 0.2;
// Another way, this far from the best one, must fit worse by this share of what fits.
constexpr double kOtherWay_m = 0.3;
constexpr double kClearMargin = 0.06;

constexpr int kIterations = 15;
constexpr double kTolerance = 1e-4;

}  // namespace

Scan evenly_thinned(const Scan& scan, std::size_t most) {
  const std::size_t step = scan.size() / most + 1;
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < scan.size(); row += step) {
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  return scan.select(rows);
}

double misfit(const Scan& source, const Target& target, const Eigen::Isometry3d& T_target_source,
              const Workers& workers) {
  constexpr std::size_t kBlock = 256;
  const double sum = workers.sum_blocks(source.size(), kBlock, 0.0, [&](std::size_t begin, std::size_t end) {
    double part = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p = T_target_source * source.points()[i];
      const auto nearest = target.tree.nearest(p, kReach_m);
      double share = 1.0;
      if (nearest && target.has_normal[nearest->index] != 0) {
        const double distance = target.normals[nearest->index].dot(p - target.scan.points()[nearest->index]) / kWidth_m;
        share = std::min(1.0, distance * distance);
      }
      part += share;
    }
    return part;
  });
  return source.size() == 0 ? 1.0 : sum / static_cast<double>(source.size());
}

std::vector<WayCandidate> search_ways(const Scan& source, const Target& target, std::span<const Eigen::Vector3d> axes,
                                      double reach_m, const Workers& workers) {
  AlignConfig config;
  config.doppler_weight = 0.0;
  config.max_correspondence_distance_m = kReach_m;
  config.max_iterations = kIterations;
  config.tolerance = kTolerance;
  const Scan aligned = evenly_thinned(source, kAlignedPoints);
  const Scan judged = evenly_thinned(source, kJudgedPoints);
  const int steps = static_cast<int>(reach_m / kStartStep_m);
  std::vector<WayCandidate> candidates;
  for (const Eigen::Vector3d& axis : axes) {
    for (int k = -steps; k <= steps; ++k) {
      WayCandidate candidate;
      candidate.T_target_source.translation() = -kStartStep_m * k * axis;
      const Alignment found = align(aligned, target, candidate.T_target_source, config, workers);
      if (found.correspondences > 0) {
        candidate.T_target_source = found.T_target_source;
      }
      candidate.cost = misfit(judged, target, candidate.T_target_source, workers);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

const WayCandidate& best_way(const std::vector<WayCandidate>& candidates) {
  return *std::min_element(candidates.begin(), candidates.end(),
                           [](const WayCandidate& a, const WayCandidate& b) { return a.cost < b.cost; });
}

bool is_clear(const std::vector<WayCandidate>& candidates) {
  const WayCandidate& best = best_way(candidates);
  return std::none_of(candidates.begin(), candidates.end(), [&](const WayCandidate& other) {
    const double apart_m = (other.T_target_source.translation() - best.T_target_source.translation()).norm();
    return apart_m > kOtherWay_m && other.cost - best.cost < kClearMargin * (1.0 - best.cost);
  });
}

}  // namespace dynamic_icp::registration
