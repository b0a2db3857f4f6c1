// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/align.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/registration/objective.hpp"

namespace dynamic_icp::registration {
namespace {

/// Root mean square distance of the points from the sensor: the lever through which a rotation moves them.
double typical_distance(const Scan& scan) {
  double sum = 0.0;
  for (const Eigen::Vector3d& point : scan.points()) {
    sum += point.squaredNorm();
  }
  return scan.empty() ? 1.0 : std::max(1e-3, std::sqrt(sum / static_cast<double>(scan.size())));
}

bool enough(const Correspondences& correspondences, const AlignConfig& config) {
  return correspondences.pairs.size() >= static_cast<std::size_t>(config.min_correspondences);
}

bool stable(const Correspondences& before, const Correspondences& after, double tolerance) {
  return std::abs(after.fitness - before.fitness) < tolerance &&
         std::abs(after.inlier_rmse - before.inlier_rmse) < tolerance;
}

/// Keeps the rotation orthogonal after many small steps.
void renormalise(Eigen::Isometry3d& T) { T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix(); }

/// Fit, spread and covariance at the final pose.
void describe_fit(Alignment& result, const Scan& source, const Target& target, const Correspondences& correspondences,
                  double length_m, const AlignConfig& config, const Workers& workers) {
  result.fitness = correspondences.fitness;
  result.inlier_rmse = correspondences.inlier_rmse;
  result.correspondences = correspondences.pairs.size();
  const Linearisation fit = linearise(source, target, correspondences, result.T_target_source, config, workers);
  result.geometry = fit.geometry;
  result.doppler = fit.doppler;
  const estimation::Solution solution = estimation::solve(fit.equations, length_m, config.rank_tolerance);
  result.information_ratio = solution.information_ratio;
  if (result.status == AlignStatus::kConverged || result.status == AlignStatus::kIterationLimit) {
    if (solution.inverse) {
      const Matrix6d covariance = *solution.inverse * fit.score * *solution.inverse;
      result.covariance = 0.5 * (covariance + covariance.transpose());
    }
  }
}

}  // namespace

ConfigFields fields(AlignConfig& config) {
  return {
      {"doppler_weight", &config.doppler_weight, 0.0, 0.999, "",
       "share of the Doppler term in the objective (lambda_v); 0 leaves it out"},
      {"tukey_geometry_m", &config.tukey_geometry_m, 1e-6, 1e3, "m",
       "point-to-plane residuals beyond this have no weight (rho_g)"},
      {"tukey_doppler_mps", &config.tukey_doppler_mps, 1e-6, 1e3, "m/s",
       "Doppler residuals beyond this have no weight (rho_v)"},
      {"max_correspondence_distance_m", &config.max_correspondence_distance_m, 1e-3, 1e3, "m",
       "a point farther than this from its nearest target point has no correspondence"},
      {"max_iterations", &config.max_iterations, 1, 10000, "", "most Gauss-Newton steps (I_max)"},
      {"tolerance", &config.tolerance, 1e-12, 1.0, "",
       "the alignment has converged when fitness and inlier RMSE (m) both change by less (epsilon)"},
      {"min_correspondences", &config.min_correspondences, 6, 1000000, "", "fewer correspondences are a failure"},
      {"rank_tolerance", &config.rank_tolerance, 0.0, 0.1, "",
       "a direction with less than this share of the best direction's information is degenerate"},
  };
}

std::string_view to_string(AlignStatus status) {
  switch (status) {
    case AlignStatus::kNotRun:
      return "not_run";
    case AlignStatus::kConverged:
      return "converged";
    case AlignStatus::kIterationLimit:
      return "iteration_limit";
    case AlignStatus::kTooFewCorrespondences:
      return "too_few_correspondences";
    case AlignStatus::kDegenerate:
      return "degenerate";
  }
  return "unknown";
}

Alignment align(const Scan& source, const Target& target, const Eigen::Isometry3d& T_initial, const AlignConfig& config,
                const Workers& workers) {
  Alignment result;
  result.T_target_source = T_initial;
  result.status = AlignStatus::kIterationLimit;
  const double length_m = typical_distance(source);
  CorrespondenceSearch search(source, target, config.max_correspondence_distance_m, workers);

  Correspondences current = search.find(result.T_target_source);
  while (result.iterations < config.max_iterations) {
    if (!enough(current, config)) {
      result.status = AlignStatus::kTooFewCorrespondences;
      break;
    }
    const Linearisation linear = linearise(source, target, current, result.T_target_source, config, workers);
    estimation::Solution step = estimation::solve(linear.equations, length_m, config.rank_tolerance);
    if (!step.degenerate.empty()) {
      result.status = AlignStatus::kDegenerate;
      result.degenerate = std::move(step.degenerate);
      break;
    }
    result.T_target_source = exp_se3(step.xi) * result.T_target_source;
    ++result.iterations;
    // The pairs at the new pose decide about stopping and are those of the next step.
    Correspondences updated = search.find(result.T_target_source);
    const bool converged = enough(updated, config) && stable(current, updated, config.tolerance);
    current = std::move(updated);
    if (converged) {
      result.status = AlignStatus::kConverged;
      break;
    }
  }
  renormalise(result.T_target_source);
  describe_fit(result, source, target, current, length_m, config, workers);
  return result;
}

}  // namespace dynamic_icp::registration
