// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_fit.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

/// Static points all around, measured during 0.1 s by a sensor in the state x.
DopplerRows measure(unsigned seed, std::size_t n, const Vector7d& x, double noise_mps, bool takes_time = true) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d point = 30.0 * Vector3d(uniform(random), uniform(random), 0.5 * uniform(random));
    const double dt = takes_time ? 0.05 * uniform(random) : 0.0;
    raw.points.push_back(point);
    raw.doppler.push_back(-point.normalized().dot(x.head<3>() + dt * x.segment<3>(3)) + x[6] +
                          noise_mps * normal(random));
    raw.times.push_back(0.05 + dt);
  }
  return sort_into_cells(Scan::from_raw(raw), 4.0, Workers(1));
}

Vector7d state() {
  Vector7d x;
  x << 5.0, -1.0, 0.3, 2.0, 1.0, -1.0, 0.1;
  return x;
}

Vector7d jacobian(const DopplerRows& rows, std::size_t i) {
  Vector7d J;
  J << rows.u(i), rows.dt[i] * rows.u(i), -1.0;
  return J;
}

double cost(const DopplerRows& rows, const Vector7d& x, const RobustScale& scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sum += estimation::tukey_loss(residual(rows, i, x), scale.cutoff_mps) / (scale.noise_mps * scale.noise_mps);
  }
  return sum;
}

TEST(DopplerFit, GradientIsThatOfTukeysCost) {
  const DopplerRows rows = measure(1, 800, state(), 0.1);
  const RobustScale scale{0.1, 0.4, 0.0};
  Vector7d x = state();
  x += Vector7d::Constant(0.05);
  const FitSums sums = sum_fit(rows, x, scale, Workers(1));
  for (int k = 0; k < 7; ++k) {
    const double h = 1e-5;
    const Vector7d step = h * Vector7d::Unit(k);
    const double slope = (cost(rows, x + step, scale) - cost(rows, x - step, scale)) / (2.0 * h);
    EXPECT_NEAR(sums.gradient[k], slope, 1e-4 * sums.gradient.norm()) << k;
  }
}

TEST(DopplerFit, SumsAreThoseOfTheTextbook) {
  const DopplerRows rows = measure(2, 500, state(), 0.1);
  const RobustScale scale{0.1, 0.4, 0.0};
  Matrix7d H = Matrix7d::Zero();
  double weights = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double w = estimation::tukey_weight(residual(rows, i, state()), scale.cutoff_mps);
    H += w * jacobian(rows, i) * jacobian(rows, i).transpose() / 0.01;
    weights += w;
  }
  std::vector<Vector7d> by_cell;
  const FitSums sums = sum_fit(rows, state(), scale, Workers(1), &by_cell);
  EXPECT_LT((sums.H - H).norm(), 1e-10 * H.norm());
  EXPECT_NEAR(sums.weights, weights, 1e-9);
  Vector7d total = Vector7d::Zero();
  for (const Vector7d& gradient : by_cell) {
    total += gradient;
  }
  EXPECT_LT((total - sums.gradient).norm(), 1e-8 * (1.0 + sums.gradient.norm()));
}

TEST(DopplerFit, InstantScansGiveTheSameSumsAsTimedOnesAtTheReferenceTime) {
  DopplerRows rows = measure(3, 500, state(), 0.1, false);
  ASSERT_FALSE(rows.takes_time);
  const FitSums instant = sum_fit(rows, state(), {}, Workers(1));
  rows.takes_time = true;  // all dt are zero
  const FitSums timed = sum_fit(rows, state(), {}, Workers(1));
  EXPECT_LT((instant.H - timed.H).norm(), 1e-12 * timed.H.norm());
  EXPECT_LT((instant.gradient - timed.gradient).norm(), 1e-10);
}

TEST(DopplerFit, ACellThatCreepsLosesItsWeightThoughItsPointsDoNot) {
  RawScan raw;
  for (int i = 0; i < 40; ++i) {
    raw.points.emplace_back(10.0, 0.5, 0.5);
    raw.doppler.push_back(0.13 + (i % 2 == 0 ? 0.05 : -0.05));  // the mean is 0.13 m/s, known to 8 mm/s
  }
  raw.points.emplace_back(10.0, 20.5, 0.5);
  raw.doppler.push_back(0.13);  // alone the same residual is noise
  const DopplerRows rows = sort_into_cells(Scan::from_raw(raw), 2.0, Workers(1));
  const RobustScale evaluated{0.05, 0.2, 0.015};
  const RobustScale plain{0.05, 0.2, 0.0};
  const FitSums with = sum_fit(rows, Vector7d::Zero(), evaluated, Workers(1));
  EXPECT_LE(with.inliers, 1u);
  EXPECT_EQ(sum_fit(rows, Vector7d::Zero(), plain, Workers(1)).inliers, 41u);
}

TEST(SolveFit, OneStepSolvesLeastSquaresWithPriors) {
  const DopplerRows rows = measure(4, 600, state(), 0.05);
  DopplerModel model;
  model.prior << 0, 0, 0, 1.5, 0.5, 0.0, 0.05;
  model.information.diagonal() << 0, 0, 0, 0.5, 0.5, 0.5, 30.0;
  FitSums sums;  // plain least squares from x = 0, psi' = w = 1
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sums.H += jacobian(rows, i) * jacobian(rows, i).transpose() / 0.0025;
    sums.gradient += jacobian(rows, i) * residual(rows, i, Vector7d::Zero()) / 0.0025;
    sums.weights += 1.0;
    sums.slopes += 1.0;
  }
  const FitStep step = solve_fit(sums, Vector7d::Zero(), model, 2.0);
  Matrix7d A = sums.H;
  A += model.information;
  const Vector7d expected = dense::solve(A, model.information * model.prior - sums.gradient);
  EXPECT_LT((step.step - expected).norm(), 1e-9);
  EXPECT_TRUE(step.open.isZero(0.0));
}

TEST(SolveFit, WithoutMeasurementsEveryDirectionIsOpenAndThePriorsHold) {
  DopplerModel model;
  model.prior[6] = 0.1;
  model.information.diagonal().tail<4>().setOnes();
  const FitStep step = solve_fit(FitSums{}, Vector7d::Zero(), model, 2.0);
  EXPECT_TRUE(step.open.isIdentity(1e-12));
  EXPECT_TRUE(step.step.head<6>().isZero(1e-12));
  EXPECT_NEAR(step.step[6], 0.1, 1e-12);
}

TEST(SandwichCovariance, AgreesWithTheTextbookForIndependentNoise) {
  const DopplerRows rows = measure(5, 20'000, state(), 0.05);
  const RobustScale scale{0.05, 100.0, 0.0};  // least squares
  DopplerModel model;
  model.information.diagonal().tail<4>().setConstant(1e-6);
  std::vector<Vector7d> by_cell;
  const FitSums sums = sum_fit(rows, state(), scale, Workers(1), &by_cell);
  const Matrix7d covariance = sandwich_covariance(rows, sums, Eigen::Matrix3d::Zero(), model, by_cell);
  const Matrix7d textbook = sums.H.inverse();
  for (int k = 0; k < 7; ++k) {
    EXPECT_NEAR(covariance(k, k) / textbook(k, k), 1.0, 0.3) << k;
  }
}

TEST(SandwichCovariance, GrowsWhereResidualsOfASectorDependOnEachOther) {
  // All points of a sector share one error of 0.05 m/s: as many independent measurements as sectors, not as points.
  DopplerRows rows = measure(6, 20'000, state(), 0.0, false);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> shared(rows.sectors);
  for (double& error : shared) {
    error = 0.05 * normal(random);
  }
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    for (std::size_t i = rows.first[c]; i < rows.first[c + 1]; ++i) {
      rows.s[i] = -rows.u(i).dot(state().head<3>()) + state()[6] + shared[rows.sector[c]];
    }
  }
  DopplerModel model;
  model.information.diagonal().tail<4>().setConstant(1e-6);
  std::vector<Vector7d> by_cell;
  const FitSums sums = sum_fit(rows, state(), {0.05, 100.0, 0.0}, Workers(1), &by_cell);
  const Matrix7d covariance = sandwich_covariance(rows, sums, Eigen::Matrix3d::Zero(), model, by_cell);
  const double points_per_sector = 20'000.0 / static_cast<double>(rows.sectors);
  EXPECT_GT(covariance(0, 0), 0.7 * points_per_sector / sums.H(0, 0));
}

TEST(NoiseFromNeighbours, IsBlindToWhatMovesCoherently) {
  DopplerRows rows = measure(8, 20'000, state(), 0.07, false);
  Vector7d still = state();
  still.segment<3>(3).setZero();
  EXPECT_NEAR(noise_from_neighbours(rows, still, 0.001, 1.0), 0.07, 0.01);
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    for (std::size_t i = rows.first[c]; c % 10 < 7 && i < rows.first[c + 1]; ++i) {
      rows.s[i] += 0.5 * static_cast<double>(c % 10 + 1);
    }
  }
  EXPECT_NEAR(noise_from_neighbours(rows, still, 0.001, 1.0), 0.07, 0.01);
}

TEST(NoiseFromNeighbours, StaysWithinItsBounds) {
  const DopplerRows rows = measure(9, 5000, state(), 0.07);
  EXPECT_EQ(noise_from_neighbours(rows, state(), 0.2, 0.5), 0.2);
  EXPECT_EQ(noise_from_neighbours(rows, state(), 0.001, 0.01), 0.01);
  EXPECT_EQ(noise_from_neighbours(DopplerRows{}, state(), 0.01, 0.25), 0.25);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
