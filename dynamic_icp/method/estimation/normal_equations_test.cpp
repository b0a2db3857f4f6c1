// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/estimation/normal_equations.hpp"

#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::estimation {
namespace {

constexpr double kRankTolerance = 1e-12;

struct Problem {
  Eigen::Matrix<double, Eigen::Dynamic, 6> J;
  Eigen::VectorXd e;
  Eigen::VectorXd w;

  [[nodiscard]] NormalEquations equations() const {
    NormalEquations result;
    for (Eigen::Index i = 0; i < e.size(); ++i) {
      result.add(J.row(i).transpose(), e[i], w[i]);
    }
    return result;
  }
};

Problem random_problem(unsigned seed, Eigen::Index n) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Problem problem;
  problem.J = Eigen::Matrix<double, Eigen::Dynamic, 6>::NullaryExpr(n, 6, [&] { return uniform(random); });
  problem.J.leftCols<3>() *= 40.0;  // rotations act through points tens of metres away
  problem.e = Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(random); });
  problem.w = Eigen::VectorXd::NullaryExpr(n, [&] { return 0.5 + 0.4 * uniform(random); });
  return problem;
}

TEST(NormalEquations, AgreeWithTheOrthogonalSolution) {
  const Problem problem = random_problem(1, 200);
  const Eigen::VectorXd root = problem.w.cwiseSqrt();
  const Vector6d expected = dense::least_squares(root.asDiagonal() * problem.J, -root.cwiseProduct(problem.e));
  const Solution solution = solve(problem.equations(), 40.0, kRankTolerance);
  EXPECT_TRUE(solution.degenerate.empty());
  EXPECT_LT((solution.xi - expected).norm(), 1e-12);
  const Matrix6d H = problem.J.transpose() * problem.w.asDiagonal() * problem.J;
  ASSERT_TRUE(solution.inverse.has_value());
  EXPECT_LT((*solution.inverse * H - Matrix6d::Identity()).norm(), 1e-10);
}

TEST(NormalEquations, SumsOfPartsEqualTheWhole) {
  const Problem problem = random_problem(2, 100);
  NormalEquations sum;
  for (Eigen::Index i = 0; i < 100; ++i) {
    NormalEquations one;
    one.add(problem.J.row(i).transpose(), problem.e[i], problem.w[i]);
    sum += one;
  }
  EXPECT_LT((sum.H - problem.equations().H).norm(), 1e-9);
  EXPECT_LT((sum.b - problem.equations().b).norm(), 1e-12);
}

TEST(NormalEquations, NameTheDirectionThatNothingConstrains) {
  Problem problem = random_problem(3, 300);
  problem.J.col(3).setZero();  // no residual sees a translation along x
  const Solution solution = solve(problem.equations(), 40.0, kRankTolerance);
  ASSERT_EQ(solution.degenerate.size(), 1u);
  EXPECT_NEAR(std::abs(solution.degenerate[0].direction[3]), 1.0, 1e-9);
  EXPECT_LT(solution.degenerate[0].information, kRankTolerance);
  EXPECT_NEAR(solution.xi[3], 0.0, 1e-12) << "no step where there is no information";
  EXPECT_FALSE(solution.inverse.has_value());
  EXPECT_TRUE(solution.xi.allFinite());
}

TEST(NormalEquations, WithoutMeasurementsAllDirectionsAreDegenerate) {
  const Solution solution = solve(NormalEquations{}, 1.0, kRankTolerance);
  EXPECT_EQ(solution.degenerate.size(), 6u);
  EXPECT_EQ(solution.information_ratio, 0.0);
  EXPECT_TRUE(solution.xi.isZero(0.0));
}

TEST(NormalEquations, ScalingMakesUnitsOfRotationIrrelevant) {
  // The same geometry in millimetres: same verdict, same rotation, translation a thousand times larger.
  const Problem metres = random_problem(4, 200);
  Problem millimetres = metres;
  millimetres.J.leftCols<3>() *= 1000.0;
  millimetres.e *= 1000.0;
  const Solution a = solve(metres.equations(), 40.0, kRankTolerance);
  const Solution b = solve(millimetres.equations(), 40'000.0, kRankTolerance);
  EXPECT_NEAR(a.information_ratio, b.information_ratio, 1e-12);
  EXPECT_LT((a.xi.head<3>() - b.xi.head<3>()).norm(), 1e-12);
  EXPECT_LT((1000.0 * a.xi.tail<3>() - b.xi.tail<3>()).norm(), 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::estimation
