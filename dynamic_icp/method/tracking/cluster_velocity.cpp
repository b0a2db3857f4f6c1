// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/cluster_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr int kIterations = 8;
constexpr double kConvergence_mps = 1e-3;
// Of the information sum u u^T, which is 1 per point along the line of sight: below this a direction counts as open.
constexpr double kOpenInformation = 1e-5;

/// The solution of A W = b in the directions that A constrains.
Eigen::Vector3d solve_constrained(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  Eigen::Vector3d W = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()[i] > kOpenInformation) {
      W += eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(b) / eigen.eigenvalues()[i]);
    }
  }
  return W;
}

}  // namespace

ClusterVelocity fit_cluster_velocity(std::span<const Eigen::Vector3d> directions, std::span<const double> radial,
                                     double sigma_mps) {
  ClusterVelocity result;
  if (directions.empty()) {
    return result;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& u : directions) {
    mean += u;
  }
  StackMemory<8192> memory;  // enough for what make_detection takes of an object
  std::pmr::vector<double> sorted(radial.begin(), radial.end(), memory.resource());
  std::pmr::vector<double> magnitudes(radial.size(), memory.resource());
  result.W = quantile_among(sorted, 0.5) * mean.normalized();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < radial.size(); ++i) {
      magnitudes[i] = std::abs(radial[i] - directions[i].dot(result.W));
    }
    sorted = magnitudes;
    const double scale = std::max(sigma_mps, kSigmaPerMad * quantile_among(sorted, 0.5));
    // Single numbers and half of the matrix: sums that stay in registers.
    double xx = 0.0, yx = 0.0, yy = 0.0, zx = 0.0, zy = 0.0, zz = 0.0;
    double bx = 0.0, by = 0.0, bz = 0.0;
    for (std::size_t i = 0; i < radial.size(); ++i) {
      const double w = estimation::tukey_weight(magnitudes[i], estimation::kTukeyTuning * scale);
      const Eigen::Vector3d& u = directions[i];
      const double wy = w * u.y();
      const double wz = w * u.z();
      const double wr = w * radial[i];
      xx += w * u.x() * u.x();
      yx += wy * u.x();
      yy += wy * u.y();
      zx += wz * u.x();
      zy += wz * u.y();
      zz += wz * u.z();
      bx += wr * u.x();
      by += wr * u.y();
      bz += wr * u.z();
    }
    Eigen::Matrix3d A;
    A << xx, yx, zx, yx, yy, zy, zx, zy, zz;
    const Eigen::Vector3d b(bx, by, bz);
    const Eigen::Vector3d last = result.W;
    result.W = solve_constrained(A, b);
    result.information = A / (scale * scale);
    result.spread_mps = scale;
    if ((result.W - last).norm() < kConvergence_mps) {
      break;
    }
  }
  for (const Eigen::Vector3d& u : directions) {
    result.signal_mps += u.dot(result.W) * u.dot(result.W);
  }
  result.signal_mps = std::sqrt(result.signal_mps / static_cast<double>(directions.size()));
  return result;
}

}  // namespace dynamic_icp::tracking
