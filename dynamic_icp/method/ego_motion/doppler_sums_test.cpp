// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_sums.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

/// Points in a few places, some of them with thousands of points, others with one: cells too large to be summed at
/// once.
DopplerRows dynamic_rows(bool takes_time) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (const int count : {1, 5000, 7, 900, 64, 2048, 1, 1025}) {
    const auto cell = static_cast<double>(raw.points.size() % 97);
    for (int i = 0; i < count; ++i) {
      raw.points.emplace_back(4.02 + 4.0 * cell + 0.02 * uniform(random), 1.0, 8.1 + 0.01 * uniform(random));
      raw.doppler.push_back(0.2 * normal(random) + (i % 50 == 0 ? 5.0 : 0.0));
      raw.times.push_back(takes_time ? 0.1 * uniform(random) : 0.0);
    }
  }
  return sort_into_cells(Scan::from_raw(raw), 4.0, Workers(1));
}

/// Row by row, from the definition.
FitSums expected_sums(const DopplerRows& rows, const Vector7d& x, const RobustScale& scale) {
  FitSums sums;
  for (std::size_t cell = 0; cell < rows.cells(); ++cell) {
    double weight = 0.0;
    double sum = 0.0;
    for (std::size_t i = rows.first[cell]; i < rows.first[cell + 1]; ++i) {
      const double w = estimation::tukey_weight(residual(rows, i, x), scale.cutoff_mps);
      weight += w;
      sum += w * residual(rows, i, x);
    }
    double cell_weight = 1.0;
    if (scale.surface_mps > 0.0 && weight > 1.0) {
      const double sigma = std::hypot(scale.noise_mps / std::sqrt(weight), scale.surface_mps);
      cell_weight = estimation::tukey_weight(sum / weight, scale.cutoff_mps / scale.noise_mps * sigma);
    }
    for (std::size_t i = rows.first[cell]; i < rows.first[cell + 1]; ++i) {
      const double e = residual(rows, i, x);
      const double w = cell_weight * estimation::tukey_weight(e, scale.cutoff_mps);
      Vector7d J;
      J << rows.u(i), rows.dt[i] * rows.u(i), -1.0;
      sums.H += w / (scale.noise_mps * scale.noise_mps) * J * J.transpose();
      sums.gradient += w * e / (scale.noise_mps * scale.noise_mps) * J;
      sums.weights += w;
      if (w > 0.0) {
        const double x2 = std::pow(e / scale.cutoff_mps, 2);
        sums.slopes += cell_weight * (1.0 - x2) * (1.0 - 5.0 * x2);
        sums.inlier_squared += e * e;
        ++sums.inliers;
      }
    }
  }
  return sums;
}

void expect_sums(const DopplerRows& rows, const RobustScale& scale) {
  Vector7d x;
  x << 0.1, -0.05, 0.02, 0.3, 0.1, -0.2, 0.01;
  const FitSums expected = expected_sums(rows, x, scale);
  const FitSums sums = sum_fit(rows, x, scale, Workers(1));
  EXPECT_LT((sums.H - expected.H).norm(), 1e-11 * expected.H.norm());
  EXPECT_LT((sums.gradient - expected.gradient).norm(), 1e-11 * expected.H.norm());
  EXPECT_NEAR(sums.weights, expected.weights, 1e-9 * expected.weights);
  EXPECT_NEAR(sums.slopes, expected.slopes, 1e-9 * expected.weights);
  EXPECT_NEAR(sums.inlier_squared, expected.inlier_squared, 1e-9 * expected.weights);
  EXPECT_EQ(sums.inliers, expected.inliers);
  std::vector<Vector7d> gradients;
  const FitSums again = sum_fit(rows, x, scale, Workers(4), &gradients);
  EXPECT_EQ(again.H, sums.H) << "the same bits for any number of threads";
  EXPECT_EQ(again.gradient, sums.gradient);
  Vector7d sum = Vector7d::Zero();
  for (const Vector7d& gradient : gradients) {
    sum += gradient;
  }
  EXPECT_LT((sum - expected.gradient).norm(), 1e-11 * expected.H.norm());
}

TEST(SumFit, IsTheSumOverTheRows) {
  for (const bool takes_time : {false, true}) {
    const DopplerRows rows = dynamic_rows(takes_time);
    ASSERT_EQ(rows.takes_time, takes_time);
    ASSERT_GT(rows.size(), 1024 * rows.cells());
    expect_sums(rows, {0.1, 0.8, 0.0});
  }
}

TEST(SumFit, JudgesCellsByTheirMean) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-30.0, 30.0);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (int i = 0; i < 20'000; ++i) {
    raw.points.emplace_back(uniform(random), uniform(random), 0.2 * uniform(random));
    raw.doppler.push_back(0.05 * normal(random) + (raw.points.back().x() > 10.0 ? 0.1 : 0.0));
    raw.times.push_back(0.1 * static_cast<double>(i) / 20'000.0);
  }
  expect_sums(sort_into_cells(Scan::from_raw(raw), 4.0, Workers(1)), {0.05, 0.25, 0.02});
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
