// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/velocity_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kDelta = 0.3;
const Vector3d kVelocity(7.0, -1.0, 0.4);

struct Rows {
  std::vector<Vector3d> directions;
  std::vector<double> range_rates;
};

/// Range rates of a body that fills a wide angle; every fifth is wrong by up to `gross_mps`.
Rows body(std::size_t n, double sigma_mps, double gross_mps = 0.0) {
  const RandomSource random(17);
  Rows rows;
  for (std::size_t i = 0; i < n; ++i) {
    const RandomSource one = random.fork(i);
    rows.directions.push_back(Vector3d(1.0, one.uniform(0, -1, 1), one.uniform(1, -0.5, 0.5)).normalized());
    rows.range_rates.push_back(rows.directions.back().dot(kVelocity) + sigma_mps * one.normal(2) +
                               (i % 5 == 0 ? one.uniform(3, 0.0, gross_mps) : 0.0));
  }
  return rows;
}

VelocityRegression regress(const Rows& rows, const std::optional<Vector3d>& start,
                           const VelocityRegressionConfig& config, int threads = 1) {
  return regress_velocity(rows.directions, rows.range_rates, start, config, Workers(threads));
}

/// Newton's method on the Huber loss, whose Hessian is the sum of u u^T over the residuals within delta: another way to
/// the same minimum than reweighting.
Vector3d newton_minimum(const Rows& rows, Vector3d v) {
  for (int k = 0; k < 100; ++k) {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    Vector3d gradient = Vector3d::Zero();
    for (std::size_t i = 0; i < rows.range_rates.size(); ++i) {
      const Vector3d& u = rows.directions[i];
      const double e = u.dot(v) - rows.range_rates[i];
      gradient += std::clamp(e, -kDelta, kDelta) * u;
      if (std::abs(e) <= kDelta) {
        hessian += u * u.transpose();
      }
    }
    v -= dense::solve(hessian, gradient);
  }
  return v;
}

TEST(VelocityRegression, FindsTheMinimumThatNewtonFindsWhateverTheRankAndTheStart) {
  const Rows rows = body(400, 0.1, 8.0);
  const Vector3d expected = newton_minimum(rows, kVelocity);
  VelocityRegressionConfig config{.huber_delta_mps = kDelta, .max_iterations = 500, .step_tolerance_mps = 1e-12};
  for (const Rank rank : {Rank::kFull, Rank::kUnknown}) {
    config.rank = rank;
    for (const std::optional<Vector3d>& start : {std::optional<Vector3d>(), std::optional<Vector3d>({-30, 5, 5})}) {
      const VelocityRegression fit = regress(rows, start, config);
      EXPECT_TRUE(fit.converged);
      EXPECT_LT((fit.velocity - expected).norm(), 1e-9);
    }
  }
}

TEST(VelocityRegression, IsLeastSquaresInOneStepWithoutAThreshold) {
  const Rows rows = body(120, 0.2, 3.0);
  Eigen::MatrixX3d U(120, 3);
  for (Eigen::Index i = 0; i < 120; ++i) {
    U.row(i) = rows.directions[static_cast<std::size_t>(i)];
  }
  const Eigen::Map<const Eigen::VectorXd> r(rows.range_rates.data(), 120);
  const Vector3d expected = dense::least_squares(U, r);
  const VelocityRegression fit =
      regress(rows, std::nullopt, {.huber_delta_mps = std::numeric_limits<double>::infinity(), .rank = Rank::kFull});
  EXPECT_EQ(fit.iterations, 1);
  EXPECT_EQ(fit.inliers, 120u);
  EXPECT_LT((fit.velocity - expected).norm(), 1e-9);
  const double variance = (U * expected - r).squaredNorm() / 117.0;
  const Eigen::Matrix3d covariance = variance * (U.transpose() * U).inverse();
  EXPECT_LT((fit.covariance - covariance).norm(), 1e-9 * covariance.norm());
  EXPECT_NEAR(fit.inlier_rms_mps, (U * expected - r).norm() / std::sqrt(120.0), 1e-9);
}

TEST(VelocityRegression, KeepsTheStartAlongWhatNoLineOfSightObserves) {
  Rows rows = body(60, 0.0);
  for (std::size_t i = 0; i < 60; ++i) {
    rows.directions[i].z() = 0.0;
    rows.directions[i].normalize();
    rows.range_rates[i] = rows.directions[i].dot(kVelocity);
  }
  const VelocityRegression fit = regress(rows, Vector3d(0, 0, 9), {.huber_delta_mps = kDelta});
  EXPECT_LT((fit.velocity - Vector3d(kVelocity.x(), kVelocity.y(), 9.0)).norm(), 1e-6);
  EXPECT_LT((fit.unobservable - Eigen::Matrix3d(Vector3d(0, 0, 1).asDiagonal())).norm(), 1e-9);
}

TEST(VelocityRegression, SameBitsForAnyNumberOfThreads) {
  const Rows rows = body(5000, 0.1, 8.0);
  const VelocityRegressionConfig config{.huber_delta_mps = kDelta};
  const VelocityRegression one = regress(rows, std::nullopt, config);
  const VelocityRegression four = regress(rows, std::nullopt, config, 4);
  EXPECT_EQ(one.velocity, four.velocity);
  EXPECT_EQ(one.covariance, four.covariance);
}

}  // namespace
}  // namespace dynamic_icp::estimation
