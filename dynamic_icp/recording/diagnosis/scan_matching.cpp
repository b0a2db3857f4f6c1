// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/scan_matching.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/preprocess/range_crop.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align.hpp"
#include "dynamic_icp/method/registration/translation_search.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kSourceVoxel_m = 0.8;
constexpr std::size_t kFinePoints = 4000;
constexpr double kFarthestPoint_m = 100.0;
constexpr std::size_t kMinPoints = 200;

// The stamps may be wrong: the search never ends before some metres.
constexpr double kMinReach_m = 4.5;
constexpr double kMaxReach_m = 6.0;

constexpr double kWorstCost = 0.5;  // misfit of the best translation
// The geometry must hold the way this well; its own covariance is a lower bound.
constexpr double kTrustedSigma_m = 0.02;

/// The points as they would have been seen at the stamp by a sensor that moves at a constant twist, by T_from_to in
/// `dt_s`.
Scan deskewed(const Scan& scan, const Eigen::Isometry3d& T_from_to, double dt_s, const Workers& workers) {
  if (dt_s <= 0.0) {
    return scan;
  }
  return motion::deskew(scan, motion::constant_sweep(motion::mean_twist(T_from_to, dt_s)), {0.0, 2.0 * dt_s}, workers);
}

registration::Alignment align(const Scan& source, const registration::Target& later,
                              const Eigen::Isometry3d& T_later_earlier, double gate_m, int iterations,
                              const Workers& workers) {
  registration::AlignConfig config;
  config.doppler_weight = 0.0;
  config.tukey_geometry_m = std::min(0.5, gate_m);
  config.max_correspondence_distance_m = gate_m;
  config.max_iterations = iterations;
  config.tolerance = 1e-4;
  return registration::align(source, later, T_later_earlier, config, workers);
}

/// Of the way, along itself, by the alignment's own covariance; large where there is none.
double translation_sigma(const registration::Alignment& alignment) {
  if (!alignment.covariance) {
    return 1e3;
  }
  const Eigen::Vector3d way = alignment.T_target_source.translation();
  const Eigen::Matrix3d covariance = alignment.covariance->bottomRightCorner<3, 3>();
  const Eigen::Vector3d along = way.norm() > 1e-6 ? Eigen::Vector3d(way.normalized()) : Eigen::Vector3d::UnitX();
  return std::sqrt(std::max(0.0, along.dot(covariance * along)));
}

std::optional<Eigen::Isometry3d> refined(const Scan& earlier, const Scan& later, double dt_s, Eigen::Isometry3d T,
                                         const Workers& workers) {
  constexpr double kGates_m[] = {0.8, 0.4};
  for (const double gate_m : kGates_m) {
    const Eigen::Isometry3d T_from_to = T.inverse();
    const Scan source = registration::evenly_thinned(
        preprocess::voxel_grid(deskewed(earlier, T_from_to, dt_s, workers), {kSourceVoxel_m}, workers), kFinePoints);
    const registration::PreparedTarget target =
        registration::search_target(deskewed(later, T_from_to, dt_s, workers), workers);
    const registration::Alignment found = align(source, target.target(), T, gate_m, 40, workers);
    if (found.status != registration::AlignStatus::kConverged &&
        found.status != registration::AlignStatus::kIterationLimit) {
      return std::nullopt;
    }
    T = found.T_target_source;
    if (gate_m == kGates_m[1] && (translation_sigma(found) > kTrustedSigma_m ||
                                  registration::misfit(source, target.target(), T, workers) > kWorstCost)) {
      return std::nullopt;
    }
  }
  return T.inverse();
}

Scan in_reach(const Scan& scan) { return preprocess::crop_range(scan, {0.5, kFarthestPoint_m}); }

}  // namespace

std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             std::span<const Eigen::Vector3d> axes, const Workers& workers) {
  const Scan from = in_reach(earlier);
  const Scan to = in_reach(later);
  if (from.size() < kMinPoints || to.size() < kMinPoints) {
    return std::nullopt;
  }
  const registration::PreparedTarget target = registration::search_target(to, workers);
  const Scan thin = preprocess::voxel_grid(from, {kSourceVoxel_m}, workers);
  const registration::InitialTranslation found = registration::search_translation(
      thin, target.target(), dt_s, {{axes.begin(), axes.end()}, kMinReach_m, kMaxReach_m}, workers);
  if (found.cost > kWorstCost || !found.is_unambiguous) {
    return std::nullopt;
  }
  return refined(from, to, dt_s, found.T_target_source, workers);
}

std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             const Eigen::Isometry3d& T_start, const Workers& workers) {
  const Scan from = in_reach(earlier);
  const Scan to = in_reach(later);
  if (from.size() < kMinPoints || to.size() < kMinPoints) {
    return std::nullopt;
  }
  return refined(from, to, dt_s, T_start.inverse(), workers);
}

}  // namespace dynamic_icp::diagnosis
