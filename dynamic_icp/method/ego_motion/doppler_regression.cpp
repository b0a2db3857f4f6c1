// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr std::size_t kUnknowns = 3;

// A direction whose eigenvalue of U^T W U is below this share of the largest one is not observed: it corresponds to
// lines of sight within 0.01 degree of a plane or a line, less than their own accuracy.
constexpr double kRankTolerance = 1e-8;

/// Weighted normal equations H dv = -b for residuals e_i = s_i + u_i . v, and what the covariance needs.
struct Sums {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();           // sum w u u^T
  Eigen::Vector3d b = Eigen::Vector3d::Zero();           // sum w u e
  Eigen::Matrix3d unweighted = Eigen::Matrix3d::Zero();  // sum u u^T
  double psi_squared = 0.0;                              // sum (w e)^2
  double inlier_squared = 0.0;                           // sum e^2 over inliers
  std::size_t inliers = 0;

  Sums& operator+=(const Sums& other) {
    H += other.H;
    b += other.b;
    unweighted += other.unweighted;
    psi_squared += other.psi_squared;
    inlier_squared += other.inlier_squared;
    inliers += other.inliers;
    return *this;
  }
};

Sums linearise(const Scan& scan, const Eigen::Vector3d& velocity, double delta, const Workers& workers) {
  return workers.sum_blocks(scan.size(), kBlock, Sums{}, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d& u = scan.directions()[i];
      const double e = scan.doppler()[i] + u.dot(velocity);
      const double w = estimation::huber_weight(e, delta);
      const Eigen::Matrix3d uu = u * u.transpose();
      sums.H += w * uu;
      sums.b += w * e * u;
      sums.unweighted += uu;
      sums.psi_squared += w * e * w * e;
      if (std::abs(e) <= delta) {
        sums.inlier_squared += e * e;
        ++sums.inliers;
      }
    }
    return sums;
  });
}

/// The pseudo-inverse of a symmetric matrix and the projector onto the directions it leaves out.
struct PseudoInverse {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d null_space = Eigen::Matrix3d::Zero();
};

PseudoInverse pseudo_inverse(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix);
  PseudoInverse result;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()[k] > kRankTolerance * eigen.eigenvalues()[2]) {
      result.inverse += axis * axis.transpose() / eigen.eigenvalues()[k];
    } else {
      result.null_space += axis * axis.transpose();
    }
  }
  return result;
}

void finish(EgoVelocity& result, const Sums& sums, std::size_t n) {
  result.inliers = sums.inliers;
  result.inlier_rms_mps = sums.inliers > 0 ? std::sqrt(sums.inlier_squared / static_cast<double>(sums.inliers)) : 0.0;
  if (n > kUnknowns && sums.inliers > 0) {
    // psi' is 1 for inliers and 0 beyond, so its mean is the share of inliers.
    const double inlier_share = static_cast<double>(sums.inliers) / static_cast<double>(n);
    const double variance = sums.psi_squared / static_cast<double>(n - kUnknowns) / (inlier_share * inlier_share);
    result.covariance = variance * pseudo_inverse(sums.unweighted).inverse;
  }
}

/// False when lines of sight that hardly determine the velocity have carried it away from anything that moves.
bool is_plausible(const EgoVelocity& ego) {
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
      {"max_iterations", &config.max_iterations, 1, 1000, "", "most reweighting steps of the regression"},
      {"step_tolerance_mps", &config.step_tolerance_mps, 1e-12, 1.0, "m/s",
       "the regression has converged when a step is shorter"},
  };
}

EgoVelocity estimate_velocity(const Scan& scan, const Eigen::Vector3d& prior_sensor,
                              const DopplerRegressionConfig& config, const Workers& workers) {
  EgoVelocity result;
  result.velocity_sensor = prior_sensor;
  result.points = scan.size();
  if (scan.size() < kUnknowns) {
    result.status = EgoVelocityStatus::kTooFewPoints;
    result.unobservable.setIdentity();
    return result;
  }
  result.status = EgoVelocityStatus::kIterationLimit;
  Sums sums = linearise(scan, result.velocity_sensor, config.huber_delta_mps, workers);
  while (result.iterations < config.max_iterations) {
    // An incremental step keeps the prior along directions that no line of sight observes.
    const PseudoInverse solver = pseudo_inverse(sums.H);
    const Eigen::Vector3d step = -solver.inverse * sums.b;
    result.velocity_sensor += step;
    result.unobservable = solver.null_space;
    ++result.iterations;
    sums = linearise(scan, result.velocity_sensor, config.huber_delta_mps, workers);
    if (step.norm() < config.step_tolerance_mps) {
      result.status = EgoVelocityStatus::kConverged;
      break;
    }
  }
  if (!result.unobservable.isZero(0.0)) {
    result.status = EgoVelocityStatus::kDegenerate;
  }
  finish(result, sums, scan.size());
  return is_plausible(result) ? result : undetermined(prior_sensor, scan.size(), result.iterations);
}

}  // namespace dynamic_icp::ego_motion
