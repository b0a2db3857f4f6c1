// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/assignment.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace dynamic_icp::evaluation {
namespace {

using Pairs = std::vector<std::optional<std::size_t>>;

double total(const Eigen::MatrixXd& scores, const Pairs& pairs) {
  double sum = 0.0;
  for (std::size_t row = 0; row < pairs.size(); ++row) {
    sum += pairs[row] ? scores(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(*pairs[row])) : 0.0;
  }
  return sum;
}

/// The greatest sum over all pairings.
double best_of_all(const Eigen::MatrixXd& scores) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(std::max(scores.rows(), scores.cols())));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  double best = 0.0;
  do {
    double sum = 0.0;
    for (Eigen::Index row = 0; row < scores.rows(); ++row) {
      const Eigen::Index column = order[static_cast<std::size_t>(row)];
      sum += column < scores.cols() ? std::max(0.0, scores(row, column)) : 0.0;
    }
    best = std::max(best, sum);
  } while (std::ranges::next_permutation(order).found);
  return best;
}

TEST(Assignment, IsTheBestOfAll) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> score(-0.5, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index rows = trial % 5;
    const Eigen::Index columns = trial / 5 % 6;
    const Eigen::MatrixXd scores = Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return score(random); });
    const Pairs pairs = best_assignment(scores);
    EXPECT_NEAR(total(scores, pairs), best_of_all(scores), 1e-12) << scores;
    std::set<std::size_t> columns_seen;
    for (const std::optional<std::size_t>& column : pairs) {
      EXPECT_TRUE(!column || columns_seen.insert(*column).second) << "twice";
    }
  }
}

TEST(Assignment, PairsNothingWithoutAScore) {
  EXPECT_TRUE(best_assignment(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(best_assignment(Eigen::MatrixXd(2, 0)), Pairs(2));
  EXPECT_EQ(best_assignment(Eigen::MatrixXd::Zero(2, 2)), Pairs(2));
  EXPECT_EQ(best_assignment(Eigen::MatrixXd::Constant(1, 1, -1.0)), Pairs(1));
}

TEST(Assignment, GivesUpAGoodPairForTwo) {
  Eigen::MatrixXd scores(2, 2);
  scores << 1.0, 0.9, 0.8, 0.0;
  EXPECT_EQ(best_assignment(scores), (Pairs{1, 0}));
}

}  // namespace
}  // namespace dynamic_icp::evaluation
