// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/field_elimination.hpp"

#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kTheta = 7;
constexpr Index kRest = 11;

struct Problem {
  MatrixXd H;
  VectorXd g;

  explicit Problem(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const MatrixXd A = MatrixXd::NullaryExpr(30, kTheta + kRest, [&] { return normal(random); });
    H = A.transpose() * A;
    g = VectorXd::NullaryExpr(kTheta + kRest, [&] { return normal(random); });
  }

  [[nodiscard]] MatrixXd F() const { return H.topLeftCorner(kTheta, kTheta); }
};

/// The step and the covariance of the rest alone, as the estimator takes them.
MatrixXd information_of_rest(const FieldElimination& elimination) {
  return elimination.rest().selfadjointView<Eigen::Lower>();
}

TEST(FieldElimination, StepsAreThoseOfTheWholeProblem) {
  const Problem problem(1);
  const FieldElimination elimination(problem.F(), problem.H, true);
  ASSERT_TRUE(elimination.is_solvable());
  const VectorXd whole = -dense::solve(problem.H, problem.g);
  const VectorXd rest = -dense::solve(information_of_rest(elimination), elimination.rest_gradient(problem.g));
  EXPECT_LT((rest - whole.tail(kRest)).norm(), 1e-9 * whole.norm());
  EXPECT_LT((elimination.step(problem.g, rest) - whole.head(kTheta)).norm(), 1e-9 * whole.norm());
}

TEST(FieldElimination, CovarianceIsThatOfTheWholeProblem) {
  const Problem problem(2);
  const FieldElimination elimination(problem.F(), problem.H, true);
  const MatrixXd covariance = dense::inverse(problem.H);
  const MatrixXd S = information_of_rest(elimination);
  EXPECT_LT((dense::inverse(S) - covariance.bottomRightCorner(kRest, kRest)).norm(), 1e-9 * covariance.norm());
  const Eigen::LLT<MatrixXd> factor(S);
  const MatrixXd root = elimination.covariance_root(factor);
  EXPECT_LT((root * root.transpose() - covariance.topLeftCorner(kTheta, kTheta)).norm(), 1e-9 * covariance.norm());
}

TEST(FieldElimination, ThePriorOfThetaMayBeInItsBlockAlone) {
  Problem problem(3);
  const MatrixXd with_prior = problem.F() + 4.0 * MatrixXd::Identity(kTheta, kTheta);
  const FieldElimination apart(with_prior, problem.H, true);
  problem.H.topLeftCorner(kTheta, kTheta) = with_prior;
  const FieldElimination together(with_prior, problem.H, true);
  EXPECT_EQ(information_of_rest(apart), information_of_rest(together));
}

TEST(FieldElimination, WhatIsNotLearnedStaysAndTakesNothing) {
  const Problem problem(4);
  const FieldElimination elimination(problem.F(), problem.H, false);
  EXPECT_LT((information_of_rest(elimination) - problem.H.bottomRightCorner(kRest, kRest)).norm(),
            1e-12 * problem.H.norm());
  EXPECT_EQ(elimination.rest_gradient(problem.g), problem.g.tail(kRest));
  EXPECT_EQ(elimination.step(problem.g, VectorXd::Ones(kRest)).norm(), 0.0);
}

TEST(FieldElimination, SaysWhenThetaIsNotKnownAtAll) {
  const Problem problem(5);
  EXPECT_FALSE(FieldElimination(MatrixXd::Zero(kTheta, kTheta), problem.H, true).is_solvable());
}

}  // namespace
}  // namespace dynamic_icp::window
