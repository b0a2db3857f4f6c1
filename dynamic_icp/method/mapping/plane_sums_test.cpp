// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/plane_sums.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::mapping {
namespace {

const Eigen::Matrix3d kR = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();

PlaneRows random_rows(std::size_t size) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  PlaneRows rows;
  rows.size = size;
  for (std::size_t i = 0; i < size; ++i) {
    const Eigen::Vector3d n = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      rows.r[k][i] = 20.0 * normal(random);
      rows.n[k][i] = n[static_cast<Eigen::Index>(k)];
    }
    rows.tau[i] = 0.05 * normal(random);
    rows.e[i] = 0.05 * normal(random);
    rows.own[i] = 1e-4 * (1.0 + std::abs(normal(random)));
    rows.common[i] = 1e-4 * std::abs(normal(random));
    rows.members[i] = static_cast<double>(1 + i % 7);
  }
  return rows;
}

/// Row by row, from the definition.
PlaneSums expected_sums(const PlaneRows& rows, bool has_times, const PlaneWeights& weights) {
  PlaneSums sums;
  for (std::size_t i = 0; i < rows.size; ++i) {
    const Eigen::Vector3d r(rows.r[0][i], rows.r[1][i], rows.r[2][i]);
    const Eigen::Vector3d n(rows.n[0][i], rows.n[1][i], rows.n[2][i]);
    const double reach = std::max(weights.gate_m, weights.kernel * std::sqrt(rows.own[i] + rows.common[i]));
    const double robust = estimation::tukey_weight(rows.e[i], reach);
    const double w = robust / (rows.own[i] + rows.members[i] * rows.common[i]);
    const double tau = has_times ? rows.tau[i] : 0.0;
    Vector12d J;
    J << r, n, tau * (kR.transpose() * r), 0.5 * tau * tau * (kR.transpose() * r);
    sums.H += w * J * J.transpose();
    sums.b += w * rows.e[i] * J;
    sums.weights += robust;
    sums.squares += robust * rows.e[i] * rows.e[i];
    sums.chi_squares += robust * rows.e[i] * rows.e[i] / (rows.own[i] + rows.common[i]);
  }
  return sums;
}

TEST(SumPlanes, IsTheSumOverTheRows) {
  for (const std::size_t size : {0U, 1U, 7U, 8U, 9U, 500U, 512U}) {
    const PlaneRows rows = random_rows(size);
    for (const bool has_times : {false, true}) {
      for (const PlaneWeights& weights : {PlaneWeights{3.0, 0.0}, PlaneWeights{3.0, 0.2}}) {
        const PlaneSums sums = sum_planes(rows, kR, has_times, weights);
        const PlaneSums expected = expected_sums(rows, has_times, weights);
        EXPECT_LT((sums.H - expected.H).norm(), 1e-11 * (1.0 + expected.H.norm())) << size;
        EXPECT_LT((sums.b - expected.b).norm(), 1e-11 * (1.0 + expected.H.norm()));
        EXPECT_NEAR(sums.weights, expected.weights, 1e-10);
        EXPECT_NEAR(sums.squares, expected.squares, 1e-10);
        EXPECT_NEAR(sums.chi_squares, expected.chi_squares, 1e-9);
        EXPECT_EQ(sums.H, Matrix12d(sums.H.transpose()));
      }
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::mapping
