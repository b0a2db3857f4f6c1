// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/scan_matching.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"
#include "dynamic_icp/method/preprocess/range_crop.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/align.hpp"
#include "dynamic_icp/method/registration/way_search.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kTargetVoxel_m = 0.4;
constexpr double kSourceVoxel_m = 0.8;
constexpr std::size_t kFinePoints = 4000;
constexpr double kFarthest_m = 100.0;
constexpr std::size_t kFewestPoints = 200;

constexpr double kFastest_mps = 45.0;
constexpr double kLeastReach_m = 4.5;
constexpr double kMostReach_m = 6.0;

constexpr double kWorstCost = 0.5;  // misfit of the best way
// The geometry must hold the way this well; its own covariance is a lower bound.
constexpr double kTrustedDeviation_m = 0.02;

/// The later scan as the target of an alignment.
struct Surroundings {
  Surroundings(const Scan& scan, const Workers& workers)
      : points(preprocess::voxel_grid(scan, {kTargetVoxel_m}, workers)),
        tree(points.points(), workers),
        normals(preprocess::estimate_normals(points.points(), tree, {}, workers)) {}

  [[nodiscard]] registration::Target target() const { return {points, tree, normals.vectors, normals.valid}; }

  Scan points;
  spatial::KdTree tree;
  preprocess::Normals normals;
};

/// The points as they would have been seen at the stamp by a sensor that moves by T_from_to in `dt_s`.
Scan made_straight(const Scan& scan, const Eigen::Isometry3d& T_from_to, double dt_s) {
  if (!scan.has_times() || dt_s <= 0.0) {
    return scan;
  }
  const Vector6d twist = log_se3(T_from_to) / dt_s;
  Scan straight = scan;
  for (std::size_t row = 0; row < scan.size(); ++row) {
    const double tau = std::clamp(scan.times()[row], 0.0, 2.0 * dt_s);
    const Eigen::Vector3d moved = exp_se3(tau * twist) * scan.points()[row];
    straight.displace(row, moved - scan.points()[row]);
  }
  return straight;
}

registration::Alignment align(const Scan& source, const Surroundings& later, const Eigen::Isometry3d& T_later_earlier,
                              double gate_m, int iterations, const Workers& workers) {
  registration::AlignConfig config;
  config.doppler_weight = 0.0;
  config.tukey_geometry_m = std::min(0.5, gate_m);
  config.max_correspondence_distance_m = gate_m;
  config.max_iterations = iterations;
  config.tolerance = 1e-4;
  return registration::align(source, later.target(), T_later_earlier, config, workers);
}

/// Of the way, along itself, by the alignment's own covariance; large where there is none.
double way_deviation(const registration::Alignment& alignment) {
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
        preprocess::voxel_grid(made_straight(earlier, T_from_to, dt_s), {kSourceVoxel_m}, workers), kFinePoints);
    const Surroundings surroundings(made_straight(later, T_from_to, dt_s), workers);
    const registration::Alignment found = align(source, surroundings, T, gate_m, 40, workers);
    if (found.status != registration::AlignStatus::kConverged &&
        found.status != registration::AlignStatus::kIterationLimit) {
      return std::nullopt;
    }
    T = found.T_target_source;
    if (gate_m == kGates_m[1] && (way_deviation(found) > kTrustedDeviation_m ||
                                  registration::misfit(source, surroundings.target(), T, workers) > kWorstCost)) {
      return std::nullopt;
    }
  }
  return T.inverse();
}

Scan in_reach(const Scan& scan) { return preprocess::crop_range(scan, {0.5, kFarthest_m}); }

}  // namespace

std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             std::span<const Eigen::Vector3d> axes, const Workers& workers) {
  const Scan from = in_reach(earlier);
  const Scan to = in_reach(later);
  if (from.size() < kFewestPoints || to.size() < kFewestPoints) {
    return std::nullopt;
  }
  const Surroundings surroundings(to, workers);
  const Scan thin = preprocess::voxel_grid(from, {kSourceVoxel_m}, workers);
  // By the stamps, but they may be wrong: never less than some metres.
  const double reach_m = std::clamp(kFastest_mps * dt_s, kLeastReach_m, kMostReach_m);
  const std::vector<registration::WayCandidate> candidates =
      registration::search_ways(thin, surroundings.target(), axes, reach_m, workers);
  if (candidates.empty()) {
    return std::nullopt;
  }
  const registration::WayCandidate& best = registration::best_way(candidates);
  if (best.cost > kWorstCost || !registration::is_clear(candidates)) {
    return std::nullopt;
  }
  return refined(from, to, dt_s, best.T_target_source, workers);
}

std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             const Eigen::Isometry3d& T_start, const Workers& workers) {
  const Scan from = in_reach(earlier);
  const Scan to = in_reach(later);
  if (from.size() < kFewestPoints || to.size() < kFewestPoints) {
    return std::nullopt;
  }
  return refined(from, to, dt_s, T_start.inverse(), workers);
}

}  // namespace dynamic_icp::diagnosis
