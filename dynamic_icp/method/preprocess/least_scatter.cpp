// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/least_scatter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::preprocess {
namespace {

constexpr int kMaxSteps = 12;
constexpr double kLastStep = 1e-15;      // of the trace
constexpr double kSmallestGap = 1e-2;    // of the middle eigenvalue
constexpr double kSmallestWidth = 1e-4;  // middle over largest eigenvalue

LeastScatter by_iteration(const Eigen::Matrix3d& scatter) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  return {eigen.eigenvectors().col(0).normalized(), eigen.eigenvalues()[1]};
}

/// The adjugate of a symmetric matrix.
Eigen::Matrix3d adjugate(double xx, double xy, double xz, double yy, double yz, double zz) {
  const double a = xz * yz - xy * zz;
  const double b = xy * yz - xz * yy;
  const double c = xy * xz - yz * xx;
  Eigen::Matrix3d result;
  result << yy * zz - yz * yz, a, b, a, xx * zz - xz * xz, c, b, c, xx * yy - xy * xy;
  return result;
}

}  // namespace

LeastScatter least_scatter(const Eigen::Matrix3d& scatter) {
  const double xx = scatter(0, 0);
  const double yy = scatter(1, 1);
  const double zz = scatter(2, 2);
  const double xy = scatter(1, 0);
  const double xz = scatter(2, 0);
  const double yz = scatter(2, 1);
  // The characteristic polynomial x^3 - trace x^2 + minors x - determinant. From 0, Newton's method climbs to its
  // smallest root and never beyond.
  const double trace = xx + yy + zz;
  const double minors = (yy * zz - yz * yz) + (xx * zz - xz * xz) + (xx * yy - xy * xy);
  const double determinant = xx * (yy * zz - yz * yz) + xy * (xz * yz - xy * zz) + xz * (xy * yz - xz * yy);
  double smallest = 0.0;
  bool arrived = false;
  for (int i = 0; i < kMaxSteps && !arrived; ++i) {
    const double value = ((smallest - trace) * smallest + minors) * smallest - determinant;
    const double slope = (3.0 * smallest - 2.0 * trace) * smallest + minors;
    const double step = value / slope;
    smallest -= step;
    arrived = std::abs(step) <= kLastStep * trace;
  }
  // The other two have this mean and this product.
  const double mean = 0.5 * (trace - smallest);
  const double product = minors - 2.0 * mean * smallest;
  const double largest = mean + std::sqrt(std::max(0.0, mean * mean - product));
  const double middle = product / largest;
  // Written so that NaN fails.
  if (!(arrived && middle > kSmallestWidth * largest && middle - smallest > kSmallestGap * middle)) {
    return by_iteration(scatter);
  }
  // All columns of adj(A - smallest I) point along the eigenvector, but for the error of the eigenvalue. Multiplied by
  // that matrix once more, the error is squared.
  const Eigen::Matrix3d adjoint = adjugate(xx - smallest, xy, xz, yy - smallest, yz, zz - smallest);
  Eigen::Index best = 0;
  adjoint.diagonal().cwiseAbs().maxCoeff(&best);
  const Eigen::Vector3d column = adjoint.col(best) / adjoint(best, best);
  return {(adjoint * column).normalized(), middle};
}

}  // namespace dynamic_icp::preprocess
