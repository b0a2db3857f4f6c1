// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_quadratic.hpp"

#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kField = 5;
constexpr std::size_t kCoefficients = 4;

// Marginalisation adds 1e-9 to what it eliminates; eigenvalues of these problems are one and more.
constexpr double kTolerance = 1e-7;

/// Everything is correlated with everything, but the tail with the coefficients and their vibration alone.
WindowQuadratic random_quadratic(unsigned seed) {
  std::mt19937 random(seed);
  WindowQuadratic quadratic(kField, kCoefficients, true);
  const Layout& at = quadratic.layout();
  const Index n = at.size();
  MatrixXd A = dense::random_matrix(random, n, 2 * n);
  A.block(0, 0, at.coefficient(0), n).setZero();
  A.bottomRightCorner(n - at.head(), n).setZero();
  quadratic.set(A * A.transpose() + MatrixXd::Identity(n, n), dense::random_matrix(random, n, 1));
  return quadratic;
}

VectorXd minimiser(const WindowQuadratic& quadratic) { return -dense::solve(quadratic.Q(), quadratic.g()); }

double value(const WindowQuadratic& quadratic, const VectorXd& d) {
  return 0.5 * d.dot(quadratic.Q() * d) + quadratic.g().dot(d);
}

std::vector<Index> range(Index begin, Index end) {
  std::vector<Index> result;
  for (Index k = begin; k < end; ++k) {
    result.push_back(k);
  }
  return result;
}

/// The quadratic over `rows` of its unknowns says what the whole one says of them and `kept`.
void expect_marginal(const WindowQuadratic& marginal, const std::vector<Index>& rows, const WindowQuadratic& whole,
                     const std::vector<Index>& kept) {
  ASSERT_EQ(rows.size(), kept.size());
  const MatrixXd Q = marginal.Q()(rows, rows);
  const MatrixXd covariance = whole.Q().inverse()(kept, kept);
  EXPECT_LT((Q.inverse() - covariance).norm(), kTolerance);
  EXPECT_LT((-Q.inverse() * marginal.g()(rows) - minimiser(whole)(kept)).norm(), kTolerance);
}

TEST(Layout, PlacesTheUnknownsOneAfterTheOther) {
  const Layout layout{kField, 2};
  const Index nodes = 6 * Layout::kMapNodes;
  EXPECT_EQ(layout.map_error(), 5);
  EXPECT_EQ(layout.map_node(1), 11);
  EXPECT_EQ(layout.last_stamp(), 5 + nodes);
  EXPECT_EQ(layout.stamp(), 6 + nodes);
  EXPECT_EQ(layout.coefficient(0), 7 + nodes);
  EXPECT_EQ(layout.coefficient(1), 13 + nodes);
  EXPECT_EQ(layout.size(), 19 + nodes);
  const Layout vibrating{kField, 2, true};
  EXPECT_EQ(vibrating.coefficient(1), 13 + nodes);
  EXPECT_EQ(vibrating.vibration(0), 19 + nodes);
  EXPECT_EQ(vibrating.vibration(1), 25 + nodes);
  EXPECT_EQ(vibrating.size(), 31 + nodes);
}

TEST(WindowQuadratic, KnowsNothingAtFirst) {
  const WindowQuadratic quadratic(kField, kCoefficients, true);
  const Index size = kField + Layout::kMapError + Layout::kStamps + 2 * 6 * static_cast<Index>(kCoefficients);
  EXPECT_EQ(quadratic.Q(), MatrixXd::Zero(size, size));
  EXPECT_EQ(quadratic.g(), VectorXd::Zero(size));
}

TEST(WindowQuadratic, NewCoefficientsAreUnknown) {
  WindowQuadratic quadratic = random_quadratic(1);
  const WindowQuadratic before = quadratic;
  quadratic.append_coefficients(3);
  EXPECT_EQ(quadratic.layout().coefficients, 7);
  const Layout& at = quadratic.layout();
  ASSERT_EQ(quadratic.Q().rows(), before.Q().rows() + 36);
  std::vector<Index> known = range(0, at.coefficient(4));
  for (const Index k : range(at.vibration(0), at.vibration(4))) {
    known.push_back(k);
  }
  EXPECT_EQ(quadratic.Q()(known, known), before.Q());
  EXPECT_EQ(quadratic.g()(known), before.g());
  EXPECT_NEAR(quadratic.Q().norm(), before.Q().norm(), 1e-9) << "and nothing else";
  EXPECT_NEAR(quadratic.g().norm(), before.g().norm(), 1e-9);
}

TEST(WindowQuadratic, DroppingCoefficientsLeavesWhatIsKnownOfTheOthers) {
  for (const Index count : {1, 3, 4}) {
    WindowQuadratic quadratic = random_quadratic(2);
    const WindowQuadratic before = quadratic;
    quadratic.drop_coefficients(static_cast<std::size_t>(count));
    EXPECT_EQ(quadratic.layout().coefficients, 4 - count);
    ASSERT_EQ(quadratic.Q().rows(), quadratic.layout().size());
    std::vector<Index> kept = range(0, before.layout().coefficient(0));
    for (const Index block : {before.layout().coefficient(0), before.layout().vibration(0)}) {
      for (const Index k : range(block + 6 * count, block + 6 * before.layout().coefficients)) {
        kept.push_back(k);
      }
    }
    expect_marginal(quadratic, range(0, quadratic.layout().size()), before, kept);
  }
}

TEST(WindowQuadratic, DroppingNothingChangesNothing) {
  WindowQuadratic quadratic = random_quadratic(3);
  const WindowQuadratic before = quadratic;
  quadratic.drop_coefficients(0);
  EXPECT_EQ(quadratic.Q(), before.Q());
  EXPECT_EQ(quadratic.g(), before.g());
}

TEST(WindowQuadratic, TheStampAtHandBecomesTheLast) {
  WindowQuadratic quadratic = random_quadratic(4);
  const WindowQuadratic before = quadratic;
  quadratic.next_stamp();
  const Layout& at = quadratic.layout();
  EXPECT_EQ(quadratic.Q().row(at.stamp()).norm(), 0.0) << "nothing is known of the new one";
  EXPECT_EQ(quadratic.Q().col(at.stamp()).norm(), 0.0);
  EXPECT_EQ(quadratic.g()[at.stamp()], 0.0);
  // The others in their places, with the stamp that was at hand in the place of the last.
  std::vector<Index> rows = range(0, at.size());
  std::erase(rows, at.stamp());
  std::vector<Index> kept = range(0, at.size());
  std::erase(kept, at.last_stamp());
  expect_marginal(quadratic, rows, before, kept);
}

TEST(WindowQuadratic, AStampThatNothingIsKnownOfIsDroppedWithoutHarm) {
  WindowQuadratic quadratic = random_quadratic(5);
  quadratic.next_stamp();
  const WindowQuadratic before = quadratic;  // the stamp at hand has no information
  quadratic.next_stamp();
  quadratic.next_stamp();
  EXPECT_TRUE(quadratic.Q().allFinite());
  EXPECT_TRUE(quadratic.g().allFinite());
  const Layout& at = quadratic.layout();
  std::vector<Index> others = range(0, at.size());
  std::erase(others, at.stamp());
  std::erase(others, at.last_stamp());
  std::vector<Index> known = range(0, at.size());
  std::erase(known, at.stamp());
  const MatrixXd covariance = before.Q()(known, known).inverse();
  std::vector<Index> in_known = range(0, at.size() - 1);
  std::erase(in_known, at.last_stamp());
  EXPECT_LT((quadratic.Q()(others, others).inverse() - covariance(in_known, in_known)).norm(), kTolerance);
}

TEST(WindowQuadratic, KeepsOfTheFieldWhatIsKnown) {
  WindowQuadratic quadratic = random_quadratic(6);
  const WindowQuadratic before = quadratic;
  quadratic.keep_field_only(7);
  EXPECT_EQ(quadratic.layout().coefficients, 7);
  ASSERT_EQ(quadratic.Q().rows(), quadratic.layout().size());
  expect_marginal(quadratic, range(0, kField), before, range(0, kField));
  const Index others = quadratic.layout().size() - kField;
  EXPECT_EQ(quadratic.Q().rightCols(others).norm(), 0.0);
  EXPECT_EQ(quadratic.Q().bottomRows(others).norm(), 0.0);
  EXPECT_EQ(quadratic.g().tail(others).norm(), 0.0);
}

TEST(WindowQuadratic, MovingTheReferenceIsAChangeOfVariables) {
  std::mt19937 random(7);
  WindowQuadratic quadratic = random_quadratic(7);
  const WindowQuadratic before = quadratic;
  const Layout& at = before.layout();
  std::vector<Matrix6d> changes;
  MatrixXd whole = MatrixXd::Identity(at.size(), at.size());  // d_before = whole d_after
  const Matrix6d map_change = dense::random_matrix(random, 6, 6);
  for (std::size_t node = 0; node < static_cast<std::size_t>(Layout::kMapNodes); ++node) {
    whole.block<6, 6>(at.map_node(node), at.map_node(node)) = map_change;
  }
  for (std::size_t k = 0; k < kCoefficients; ++k) {
    changes.emplace_back(dense::random_matrix(random, 6, 6));
    whole.block(at.coefficient(k), at.coefficient(k), 6, 6) = changes.back();
    whole.block(at.vibration(k), at.vibration(k), 6, 6) = changes.back();
  }
  quadratic.move_reference(changes, map_change);
  for (int k = 0; k < 10; ++k) {
    const VectorXd after = dense::random_matrix(random, at.size(), 1);
    const double expected = value(before, whole * after);
    EXPECT_NEAR(value(quadratic, after), expected, 1e-10 * std::abs(expected) + 1e-9);
  }
  EXPECT_LT((quadratic.Q() - quadratic.Q().transpose()).norm(), 1e-9 * quadratic.Q().norm());
}

TEST(WindowQuadratic, MixingTheMapErrorIsAChangeOfVariables) {
  std::mt19937 random(8);
  for (const double share : {0.1, 0.5}) {
    WindowQuadratic quadratic = random_quadratic(8);
    const WindowQuadratic before = quadratic;
    const Layout& at = before.layout();
    const MatrixXd J = dense::random_matrix(random, Layout::kMapError, 6 * at.coefficients);
    quadratic.mix_map_error(share, J);
    for (int k = 0; k < 10; ++k) {
      const VectorXd d = dense::random_matrix(random, at.size(), 1);
      VectorXd mixed = d;
      mixed.segment(at.map_error(), Layout::kMapError) = (1.0 - share) * d.segment(at.map_error(), Layout::kMapError) +
                                                         share * J * d.segment(at.coefficient(0), J.cols());
      const double expected = value(before, d);
      EXPECT_NEAR(value(quadratic, mixed), expected, 1e-10 * std::abs(expected) + 1e-9);
    }
    EXPECT_LT((quadratic.Q() - quadratic.Q().transpose()).norm(), 1e-9 * quadratic.Q().norm());
  }
}

TEST(WindowQuadratic, AWalkAddsToTheCovarianceAndKeepsTheEstimate) {
  std::mt19937 random(9);
  WindowQuadratic quadratic = random_quadratic(9);
  const WindowQuadratic before = quadratic;
  const MatrixXd W = dense::random_information(random, 3);
  quadratic.walk(1, W);
  MatrixXd covariance = before.Q().inverse();
  covariance.block(1, 1, 3, 3) += W;
  EXPECT_LT((quadratic.Q() - covariance.inverse()).norm(), 1e-8 * before.Q().norm());
  EXPECT_LT((minimiser(quadratic) - minimiser(before)).norm(), kTolerance);
}

TEST(WindowQuadratic, AWalkOfWhatIsUnknownChangesNothing) {
  WindowQuadratic quadratic(kField, kCoefficients, true);
  quadratic.walk(0, MatrixXd::Identity(2, 2));
  EXPECT_EQ(quadratic.Q().norm(), 0.0);
  EXPECT_EQ(quadratic.g().norm(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::window
