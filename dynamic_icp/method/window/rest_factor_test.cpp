// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/rest_factor.hpp"

#include <limits>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kHead = 90;

MatrixXd random_matrix(std::mt19937& random, Index rows, Index columns) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

MatrixXd random_information(std::mt19937& random, Index n) {
  const MatrixXd A = random_matrix(random, n, 2 * n);
  return A * A.transpose() + MatrixXd::Identity(n, n);
}

RestFactor factor_of(const MatrixXd& S) {
  const MatrixXd lower = S.triangularView<Eigen::Lower>();  // nothing else is read
  RestFactor factor;
  factor.set_tail(lower.bottomRows(S.rows() - kHead));
  factor.compute(lower.topLeftCorner(kHead, kHead));
  return factor;
}

TEST(RestFactor, SolvesAndKnowsTheCovarianceWithAndWithoutATail) {
  for (const Index tail : {0, 50}) {
    std::mt19937 random(1);
    const MatrixXd S = random_information(random, kHead + tail);
    const RestFactor factor = factor_of(S);
    ASSERT_TRUE(factor.is_solvable());
    ASSERT_EQ(factor.size(), S.rows());
    const VectorXd b = random_matrix(random, S.rows(), 1);
    EXPECT_LT((factor.solve(b) - S.inverse() * b).norm(), 1e-11 * b.norm());
    const MatrixXd sums = random_matrix(random, S.rows(), 4);
    const MatrixXd root = factor.covariance_root(sums);
    const MatrixXd covariance = sums.transpose() * S.inverse() * sums;
    EXPECT_LT((root.transpose() * root - covariance).norm(), 1e-11 * covariance.norm());
  }
}

TEST(RestFactor, TheTailHoldsForOtherHeads) {
  std::mt19937 random(2);
  MatrixXd S = random_information(random, kHead + 4);
  RestFactor factor = factor_of(S);
  S.topLeftCorner(kHead, kHead) += random_information(random, kHead);
  factor.compute(S.topLeftCorner(kHead, kHead));
  const VectorXd b = random_matrix(random, S.rows(), 1);
  EXPECT_LT((factor.solve(b) - S.inverse() * b).norm(), 1e-11 * b.norm());
}

TEST(RestFactor, SaysWhenThereIsNoSolution) {
  std::mt19937 random(3);
  const MatrixXd S = random_information(random, kHead + 4);
  for (const Index at : {Index{0}, kHead + 2}) {
    MatrixXd negative = S;
    negative(at, at) = -1.0;
    EXPECT_FALSE(factor_of(negative).is_solvable());
    MatrixXd unknown = S;
    unknown(S.rows() - 1, at) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(factor_of(unknown).is_solvable());
  }
}

}  // namespace
}  // namespace dynamic_icp::window
