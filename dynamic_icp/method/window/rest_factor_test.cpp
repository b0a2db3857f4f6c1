// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/rest_factor.hpp"

#include <limits>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kHead = 90;

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
    const MatrixXd S = dense::random_information(random, kHead + tail);
    const RestFactor factor = factor_of(S);
    ASSERT_TRUE(factor.is_solvable());
    ASSERT_EQ(factor.size(), S.rows());
    const VectorXd b = dense::random_matrix(random, S.rows(), 1);
    EXPECT_LT((factor.solve(b) - S.inverse() * b).norm(), 1e-11 * b.norm());
    const MatrixXd sums = dense::random_matrix(random, S.rows(), 4);
    const MatrixXd root = factor.covariance_root(sums);
    const MatrixXd covariance = sums.transpose() * S.inverse() * sums;
    EXPECT_LT((root.transpose() * root - covariance).norm(), 1e-11 * covariance.norm());
  }
}

TEST(RestFactor, TheTailHoldsForOtherHeads) {
  std::mt19937 random(2);
  MatrixXd S = dense::random_information(random, kHead + 4);
  RestFactor factor = factor_of(S);
  S.topLeftCorner(kHead, kHead) += dense::random_information(random, kHead);
  factor.compute(S.topLeftCorner(kHead, kHead));
  const VectorXd b = dense::random_matrix(random, S.rows(), 1);
  EXPECT_LT((factor.solve(b) - S.inverse() * b).norm(), 1e-11 * b.norm());
}

TEST(RestFactor, SaysWhenThereIsNoSolution) {
  std::mt19937 random(3);
  const MatrixXd S = dense::random_information(random, kHead + 4);
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
