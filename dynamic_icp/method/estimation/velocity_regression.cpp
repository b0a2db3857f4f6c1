// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/velocity_regression.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::estimation {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr std::size_t kUnknowns = 3;

// A direction whose eigenvalue of U^T W U is below this share of the largest one is not observed: it corresponds to
// lines of sight within 0.01 degree of a plane or a line, less than their own accuracy.
constexpr double kRankTolerance = 1e-8;

struct Rows {
  std::span<const Eigen::Vector3d> directions;
  std::span<const double> range_rates;

  [[nodiscard]] std::size_t size() const { return range_rates.size(); }
  [[nodiscard]] double residual(std::size_t i, const Eigen::Vector3d& velocity) const {
    return directions[i].dot(velocity) - range_rates[i];
  }
};

/// Weighted normal equations H dv = -b.
struct Equations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  // sum w u u^T
  Eigen::Vector3d b = Eigen::Vector3d::Zero();  // sum w u e

  Equations& operator+=(const Equations& other) {
    H += other.H;
    b += other.b;
    return *this;
  }
};

Equations linearise(const Rows& rows, const Eigen::Vector3d& velocity, double delta, const Workers& workers) {
  return workers.sum_blocks(rows.size(), kBlock, Equations{}, [&](std::size_t begin, std::size_t end) {
    Equations sums;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d& u = rows.directions[i];
      const double e = rows.residual(i, velocity);
      const double w = huber_weight(e, delta);
      const Eigen::Matrix3d uu = u * u.transpose();
      sums.H += w * uu;
      sums.b += w * e * u;
    }
    return sums;
  });
}

/// What the covariance needs.
struct Residuals {
  Eigen::Matrix3d UtU = Eigen::Matrix3d::Zero();
  double psi_squared = 0.0;     // sum (w e)^2
  double inlier_squared = 0.0;  // sum e^2 over inliers
  std::size_t inliers = 0;

  Residuals& operator+=(const Residuals& other) {
    UtU += other.UtU;
    psi_squared += other.psi_squared;
    inlier_squared += other.inlier_squared;
    inliers += other.inliers;
    return *this;
  }
};

Residuals sum_residuals(const Rows& rows, const Eigen::Vector3d& velocity, double delta, const Workers& workers) {
  return workers.sum_blocks(rows.size(), kBlock, Residuals{}, [&](std::size_t begin, std::size_t end) {
    Residuals sums;
    for (std::size_t i = begin; i < end; ++i) {
      const double e = rows.residual(i, velocity);
      const double psi = huber_weight(e, delta) * e;
      sums.UtU += rows.directions[i] * rows.directions[i].transpose();
      sums.psi_squared += psi * psi;
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

/// An incremental step keeps the start along directions that no line of sight observes.
Eigen::Vector3d solve_step(const Equations& equations, Rank rank, Eigen::Matrix3d& unobservable) {
  if (rank == Rank::kFull) {
    return -equations.H.ldlt().solve(equations.b);
  }
  const PseudoInverse solver = pseudo_inverse(equations.H);
  unobservable = solver.null_space;
  return -solver.inverse * equations.b;
}

void finish(VelocityRegression& result, const Residuals& sums, std::size_t n, Rank rank) {
  result.inliers = sums.inliers;
  result.inlier_rms_mps = sums.inliers > 0 ? std::sqrt(sums.inlier_squared / static_cast<double>(sums.inliers)) : 0.0;
  if (n > kUnknowns && sums.inliers > 0) {
    // psi' is 1 for inliers and 0 beyond, so its mean is the share of inliers.
    const double inlier_share = static_cast<double>(sums.inliers) / static_cast<double>(n);
    const double variance = sums.psi_squared / static_cast<double>(n - kUnknowns) / (inlier_share * inlier_share);
    result.covariance =
        variance * (rank == Rank::kFull ? Eigen::Matrix3d(sums.UtU.inverse()) : pseudo_inverse(sums.UtU).inverse);
  }
}

}  // namespace

VelocityRegression regress_velocity(std::span<const Eigen::Vector3d> directions, std::span<const double> range_rates,
                                    const std::optional<Eigen::Vector3d>& start, const VelocityRegressionConfig& config,
                                    const Workers& workers) {
  const Rows rows{directions, range_rates};
  VelocityRegression result;
  result.velocity = start.value_or(Eigen::Vector3d::Zero());
  while (result.iterations < config.max_iterations && !result.converged) {
    // From nowhere the first residuals say nothing yet.
    const bool weigh_alike = !start && result.iterations == 0;
    const double delta = weigh_alike ? std::numeric_limits<double>::infinity() : config.huber_delta_mps;
    const Equations equations = linearise(rows, result.velocity, delta, workers);
    const Eigen::Vector3d step = solve_step(equations, config.rank, result.unobservable);
    result.velocity += step;
    ++result.iterations;
    result.converged = step.norm() < config.step_tolerance_mps || std::isinf(config.huber_delta_mps);
  }
  finish(result, sum_residuals(rows, result.velocity, config.huber_delta_mps, workers), rows.size(), config.rank);
  return result;
}

}  // namespace dynamic_icp::estimation
