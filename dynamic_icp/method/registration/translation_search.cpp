// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/translation_search.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::registration {
namespace {

constexpr double kFastest_mps = 45.0;
constexpr double kTargetVoxel_m = 0.4;
constexpr std::size_t kAlignedPoints = 700;
constexpr std::size_t kEvaluatedPoints = 4000;
constexpr double kStartStep_m = 0.8;
constexpr double kReach_m = 1.0;
constexpr double kWidth_m = 0.2;
// Another motion, this far from the best one, must fit worse by this share of what fits.
constexpr double kOtherMotion_m = 0.3;
constexpr double kClearMargin = 0.06;

constexpr int kIterations = 15;
constexpr double kTolerance = 1e-4;

struct Candidate {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  double cost = 1.0;
};

/// In the order of the starts; several may be the same motion.
std::vector<Candidate> candidates_along(const std::vector<Eigen::Vector3d>& axes, double reach_m, const Scan& source,
                                        const Target& target, const Workers& workers) {
  AlignConfig config;
  config.doppler_weight = 0.0;
  config.max_correspondence_distance_m = kReach_m;
  config.max_iterations = kIterations;
  config.tolerance = kTolerance;
  const Scan aligned = evenly_thinned(source, kAlignedPoints);
  const Scan evaluated = evenly_thinned(source, kEvaluatedPoints);
  const int steps = static_cast<int>(reach_m / kStartStep_m);
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& axis : axes) {
    for (int k = -steps; k <= steps; ++k) {
      Candidate candidate;
      candidate.T_target_source.translation() = -kStartStep_m * k * axis;
      const Alignment found = align(aligned, target, candidate.T_target_source, config, workers);
      if (found.correspondences > 0) {
        candidate.T_target_source = found.T_target_source;
      }
      candidate.cost = misfit(evaluated, target, candidate.T_target_source, workers);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

bool is_unambiguous(const Candidate& best, const std::vector<Candidate>& candidates) {
  return std::ranges::none_of(candidates, [&](const Candidate& other) {
    const double apart_m = (other.T_target_source.translation() - best.T_target_source.translation()).norm();
    return apart_m > kOtherMotion_m && other.cost - best.cost < kClearMargin * (1.0 - best.cost);
  });
}

}  // namespace

InitialTranslation search_translation(const Scan& source, const Target& target, double dt_s,
                                      const TranslationSearch& search, const Workers& workers) {
  const double reach_m = std::clamp(kFastest_mps * dt_s, search.min_reach_m, search.max_reach_m);
  const std::vector<Candidate> candidates = candidates_along(search.axes, reach_m, source, target, workers);
  if (candidates.empty()) {
    return {};
  }
  const Candidate& best = *std::ranges::min_element(candidates, {}, &Candidate::cost);
  return {best.T_target_source, best.cost, is_unambiguous(best, candidates)};
}

PreparedTarget search_target(const Scan& scan, const Workers& workers) {
  return {preprocess::voxel_grid(scan, {kTargetVoxel_m}, workers), {}, workers};
}

double misfit(const Scan& source, const Target& target, const Eigen::Isometry3d& T_target_source,
              const Workers& workers) {
  constexpr std::size_t kBlock = 256;
  const double sum = workers.sum_blocks(source.size(), kBlock, 0.0, [&](std::size_t begin, std::size_t end) {
    double part = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<double> distance_m = plane_distance(target, T_target_source * source.points()[i], kReach_m);
      const double widths = distance_m.value_or(kWidth_m) / kWidth_m;
      part += std::min(1.0, widths * widths);
    }
    return part;
  });
  return source.size() == 0 ? 1.0 : sum / static_cast<double>(source.size());
}

Scan evenly_thinned(const Scan& scan, std::size_t most) {
  const std::size_t step = scan.size() / most + 1;
  std::vector<std::uint32_t> rows;
  for (std::size_t row = 0; row < scan.size(); row += step) {
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  return scan.select(rows);
}

}  // namespace dynamic_icp::registration
