// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/estimation/velocity_regression.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kVelocityUnknowns = 3;

/// False when lines of sight that hardly determine the velocity have carried it away from anything that moves.
bool is_plausible_velocity(const EgoVelocity& ego) {
  return ego.velocity_sensor.norm() <= kMaxDoppler_mps && ego.covariance.allFinite();
}

/// The prior, where the scan does not determine a velocity.
EgoVelocity undetermined(const Eigen::Vector3d& prior_sensor, std::size_t points, int iterations) {
  EgoVelocity result;
  result.status = EgoVelocityStatus::kDegenerate;
  result.velocity_sensor = prior_sensor;
  result.unobservable.setIdentity();
  result.points = points;
  result.iterations = iterations;
  return result;
}

}  // namespace

ConfigFields fields(DopplerRegressionConfig& config) {
  return {
      {"huber_delta_mps", &config.huber_delta_mps, 1e-3, 100.0, "m/s",
       "residuals beyond this Doppler error lose weight (Huber)"},
      {"max_iterations", &config.max_iterations, 1, 1000, "", "maximum number of reweighting steps of the regression"},
      {"step_tolerance_mps", &config.step_tolerance_mps, 1e-12, 1.0, "m/s",
       "the regression has converged when a step is shorter"},
  };
}

EgoVelocity estimate_velocity(const Scan& scan, const Eigen::Vector3d& prior_sensor,
                              const DopplerRegressionConfig& config, const Workers& workers) {
  EgoVelocity result;
  result.velocity_sensor = prior_sensor;
  result.points = scan.size();
  if (scan.size() < kVelocityUnknowns) {
    result.status = EgoVelocityStatus::kTooFewPoints;
    result.unobservable.setIdentity();
    return result;
  }
  // To the sensor the static scene moves with -v.
  const estimation::VelocityRegression scene =
      estimation::regress_velocity(scan.directions(), scan.doppler(), -prior_sensor,
                                   {.huber_delta_mps = config.huber_delta_mps,
                                    .max_iterations = config.max_iterations,
                                    .step_tolerance_mps = config.step_tolerance_mps},
                                   workers);
  result.status = !scene.unobservable.isZero(0.0) ? EgoVelocityStatus::kDegenerate
                  : scene.converged               ? EgoVelocityStatus::kConverged
                                                  : EgoVelocityStatus::kIterationLimit;
  result.velocity_sensor = -scene.velocity;
  result.covariance = scene.covariance;
  result.unobservable = scene.unobservable;
  result.iterations = scene.iterations;
  result.inliers = scene.inliers;
  result.inlier_rms_mps = scene.inlier_rms_mps;
  return is_plausible_velocity(result) ? result : undetermined(prior_sensor, scan.size(), result.iterations);
}

}  // namespace dynamic_icp::ego_motion
