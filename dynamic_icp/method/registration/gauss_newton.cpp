// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::registration {
namespace {

bool enough(const Fit& fit, const StopRule& stop) {
  return fit.pairs >= static_cast<std::size_t>(stop.min_correspondences);
}

bool stable(const Fit& before, const Fit& after, double tolerance) {
  return std::abs(after.fitness - before.fitness) < tolerance &&
         std::abs(after.inlier_rmse - before.inlier_rmse) < tolerance;
}

/// Whether points of both scans can lie near each other at this pose; false when it is not finite.
bool is_in_reach(const Eigen::Isometry3d& T) {
  return T.linear().allFinite() && T.translation().norm() <= 2.0 * kMaxCoordinate_m;
}

/// Keeps the rotation orthogonal after many small steps.
void renormalise(Eigen::Isometry3d& T) { T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix(); }

/// Fit, spread and covariance at the final pose.
void describe_fit(Alignment& result, const Problem& problem, const Correspondences& correspondences, double length_m,
                  double rank_tolerance) {
  result.fitness = correspondences.fitness;
  result.inlier_rmse = correspondences.inlier_rmse;
  result.correspondences = correspondences.pairs.size();
  const Linearisation fit = problem.linearise(correspondences, result.T_target_source, result.iterations);
  result.geometry = fit.geometry;
  result.doppler = fit.doppler;
  const estimation::Solution solution = estimation::solve(fit.equations, length_m, rank_tolerance);
  result.information_ratio = solution.information_ratio;
  if (result.status == AlignStatus::kConverged || result.status == AlignStatus::kIterationLimit) {
    if (solution.inverse) {
      const Matrix6d covariance = *solution.inverse * fit.score * *solution.inverse;
      result.covariance = 0.5 * (covariance + covariance.transpose());
    }
  }
}

}  // namespace

double typical_distance(const Scan& scan) {
  double sum = 0.0;
  for (const Eigen::Vector3d& point : scan.points()) {
    sum += point.squaredNorm();
  }
  return scan.empty() ? 1.0 : std::max(1e-3, std::sqrt(sum / static_cast<double>(scan.size())));
}

Alignment minimise(Problem& problem, const Eigen::Isometry3d& T_initial, double length_m, const StopRule& stop) {
  Alignment result;
  result.T_target_source = T_initial;
  result.status = AlignStatus::kIterationLimit;
  result.length_m = length_m;

  Fit current = problem.associate(result.T_target_source);
  while (result.iterations < stop.max_iterations) {
    if (!enough(current, stop)) {
      result.status = AlignStatus::kTooFewCorrespondences;
      break;
    }
    estimation::Solution step =
        estimation::solve(problem.equations(result.T_target_source, result.iterations), length_m, stop.rank_tolerance);
    if (!step.degenerate.empty()) {
      result.status = AlignStatus::kDegenerate;
      result.degenerate = std::move(step.degenerate);
      break;
    }
    const Eigen::Isometry3d T_next = exp_se3(step.xi) * result.T_target_source;
    if (!is_in_reach(T_next)) {
      result.status = AlignStatus::kDiverged;
      break;
    }
    result.T_target_source = T_next;
    ++result.iterations;
    // The pairs at the new pose decide about stopping and are those of the next step.
    const Fit updated = problem.associate(result.T_target_source);
    const bool converged =
        enough(updated, stop) && (stable(current, updated, stop.tolerance) || step.xi.norm() < stop.min_step);
    current = updated;
    if (converged) {
      result.status = AlignStatus::kConverged;
      break;
    }
  }
  if (result.status == AlignStatus::kIterationLimit && !enough(current, stop)) {
    result.status = AlignStatus::kTooFewCorrespondences;  // the last step threw the pose away
  }
  renormalise(result.T_target_source);
  describe_fit(result, problem, problem.correspondences(), length_m, stop.rank_tolerance);
  return result;
}

}  // namespace dynamic_icp::registration
