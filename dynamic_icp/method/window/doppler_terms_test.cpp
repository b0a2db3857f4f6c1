// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_terms.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/quantile.hpp"

#include "testing/one_thread.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kSpacing_s = 0.0125;
constexpr double kSweep_s = 0.1;
constexpr double kPointSigma_mps = 0.05;
constexpr double kCellVariance = 0.03 * 0.03;
constexpr double kScanVariance = 0.02 * 0.02;

/// A sensor that drives, turns and sways; its Doppler has an error, noise, and lever arms if asked for.
struct CellProblem {
  double stamp_s = 0.0;
  bool has_lever_arms = false;
  SplineTrajectory trajectory{kSpacing_s};
  std::vector<DopplerCell> cells;
  std::optional<DopplerErrorField> field;
  VectorXd theta;
  double scan_error_mps = 0.0;

  explicit CellProblem(double stamp = 7.3, bool lever_arms = false, std::size_t count = 400)
      : stamp_s(stamp), has_lever_arms(lever_arms) {
    trajectory.begin(stamp_s, stamp_s + kSweep_s, Eigen::Isometry3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
    for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
      const double t = kSpacing_s * (static_cast<double>(k) - 1.0);
      trajectory.coefficients()[k] << 0.01 * std::sin(8.0 * t), 0.1 * t, 0.3 * t + 0.5 * t * t, 10.0 * t - 2.0 * t * t,
          0.05 * std::sin(7.0 * t), 0.02 * t;
    }
    add_cells(count);
    field.emplace(cells, 1);
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    theta = VectorXd::NullaryExpr(static_cast<Index>(field->size()), [&] { return 0.02 * normal(random); });
    for (DopplerCell& cell : cells) {
      cell.s = 0.0;
      cell.s = -residual(cell) + 0.06 * normal(random);
    }
  }

  [[nodiscard]] DopplerTerms terms() const {
    return {cells, columns(), state(), stamp_s, kCellVariance, has_lever_arms, kOneThread};
  }

  [[nodiscard]] DopplerState state() const { return {trajectory, theta, scan_error_mps}; }

  [[nodiscard]] std::vector<FieldColumns> columns() const {
    std::vector<FieldColumns> result;
    field->columns(cells, kOneThread, result);
    return result;
  }

  [[nodiscard]] Layout layout() const { return {theta.size(), static_cast<Index>(trajectory.coefficients().size())}; }

  /// s + u . v(t) + (l x u) . omega(t) - Phi theta
  [[nodiscard]] double residual(const DopplerCell& cell) const {
    const TrajectoryPoint at = trajectory.at(stamp_s + cell.time_s);
    const double by_turn = has_lever_arms ? cell.lxu.dot(at.omega) : 0.0;
    return cell.s + cell.u.dot(at.velocity) + by_turn - field->at(cell, theta);
  }

  [[nodiscard]] VectorXd residuals() const {
    VectorXd result(static_cast<Index>(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      result[static_cast<Index>(k)] = residual(cells[k]);
    }
    return result;
  }

  /// Tukey's weight over the variance of each cell. The scale: a quarter of normal errors are below sigma / 3.138.
  [[nodiscard]] VectorXd weights() const {
    const VectorXd e = residuals();
    const auto variance = [&](std::size_t k) { return 1.0 / cells[k].weight + kCellVariance; };
    std::vector<double> sizes;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      sizes.push_back(std::abs(e[static_cast<Index>(k)]) / std::sqrt(variance(k)));
    }
    const double reach = 4.5 * std::max(1.0, 3.138 * quantile(sizes, 0.25));
    VectorXd result(e.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double inside = std::max(0.0, 1.0 - std::pow(sizes[k] / reach, 2));
      result[static_cast<Index>(k)] = inside * inside / variance(k);
    }
    return result;
  }

  /// Derivatives of the residuals by all unknowns, by central differences.
  [[nodiscard]] MatrixXd jacobian() const {
    constexpr double kStep = 1e-5;
    const Layout at = layout();
    MatrixXd J = MatrixXd::Zero(static_cast<Index>(cells.size()), at.size());
    CellProblem moved = *this;
    const auto differentiate = [&](double& unknown, Index column) {
      const double value = unknown;
      unknown = value + kStep;
      J.col(column) = moved.residuals();
      unknown = value - kStep;
      J.col(column) -= moved.residuals();
      J.col(column) /= 2.0 * kStep;
      unknown = value;
    };
    for (Index k = 0; k < theta.size(); ++k) {
      differentiate(moved.theta[k], k);
    }
    for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
      for (Index axis = 0; axis < 6; ++axis) {
        differentiate(moved.trajectory.coefficients()[k][axis], at.coefficient(k) + axis);
      }
    }
    return J;
  }

 private:
  void add_cells(std::size_t count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (std::size_t k = 0; k < count; ++k) {
      DopplerCell cell;
      const double azimuth = 3.0 * uniform(random);
      const double elevation = 0.4 * uniform(random);
      cell.u << std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation);
      cell.lxu = has_lever_arms ? Vector3d(1.5, k % 2 == 0 ? 0.8 : -0.8, 1.9).cross(cell.u) : Vector3d::Zero();
      cell.time_s = 0.5 * kSweep_s * (1.0 + uniform(random));
      cell.range_m = 30.0 + 25.0 * uniform(random);
      cell.intensity = 10.0 + 5.0 * uniform(random);
      cell.weight = (2.0 + uniform(random)) / (kPointSigma_mps * kPointSigma_mps);
      cell.points = 2.0;
      cell.line = static_cast<std::uint16_t>(k % 4);
      cells.push_back(cell);
    }
  }
};

struct Sums {
  MatrixXd H;
  VectorXd g;
  DopplerTerms::ScanError scan_error;
};

Sums sums_of(const CellProblem& problem, const DopplerTerms& of) {
  const Layout at = problem.layout();
  Sums sums{MatrixXd::Zero(at.size(), at.size()), VectorXd::Zero(at.size()), {}};
  DopplerTerms terms = of;
  terms.linearise(problem.trajectory);
  terms.add_information(at, kScanVariance, sums.H);
  sums.H = MatrixXd(sums.H.selfadjointView<Eigen::Lower>());
  sums.scan_error = terms.add_gradient(problem.trajectory, problem.theta, at, kScanVariance, sums.g);
  return sums;
}

/// Changes of the motion that are polynomials in time up to the second degree, and theta.
MatrixXd smooth_changes(const Layout& at) {
  MatrixXd B = MatrixXd::Zero(at.size(), at.field + 18);
  B.topLeftCorner(at.field, at.field).setIdentity();
  for (Index axis = 0; axis < 6; ++axis) {
    for (Index degree = 0; degree < 3; ++degree) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(at.coefficients); ++k) {
        const double t = static_cast<double>(k) / 10.0 - 0.4;
        B(at.coefficient(k) + axis, at.field + 3 * axis + degree) = std::pow(t, static_cast<double>(degree));
      }
    }
  }
  return B;
}

/// Each coefficient of the position by itself.
MatrixXd single_changes(const Layout& at) {
  MatrixXd B = MatrixXd::Zero(at.size(), 3 * at.coefficients);
  for (Index k = 0; k < at.coefficients; ++k) {
    B.block(at.coefficient(static_cast<std::size_t>(k)) + 3, 3 * k, 3, 3).setIdentity();
  }
  return B;
}

struct Expected {
  MatrixXd J;
  VectorXd weights;
  VectorXd residuals;
};

/// H = J^T W J and g = J^T W e along some changes, less what the error takes that all of a scan have in common; in
/// units of what each is known to by itself.
void expect_along(const MatrixXd& changes, const Sums& sums, const Expected& expected, double tolerance) {
  const MatrixXd J = expected.J * changes;
  const VectorXd U = J.transpose() * expected.weights;
  const double variance = 1.0 / (expected.weights.sum() + 1.0 / kScanVariance);
  const MatrixXd H = J.transpose() * expected.weights.asDiagonal() * J - variance * U * U.transpose();
  const VectorXd g = J.transpose() * expected.weights.cwiseProduct(expected.residuals) -
                     variance * expected.weights.dot(expected.residuals) * U;
  VectorXd scale(H.rows());
  for (Index k = 0; k < scale.size(); ++k) {
    scale[k] = H(k, k) > 1e-6 ? 1.0 / std::sqrt(H(k, k)) : 0.0;  // else nothing is seen of it
  }
  const MatrixXd H_off = scale.asDiagonal() * (changes.transpose() * sums.H * changes - H) * scale.asDiagonal();
  const VectorXd g_off = scale.cwiseProduct(changes.transpose() * sums.g - g);
  EXPECT_LT(H_off.cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT(g_off.cwiseAbs().maxCoeff(), tolerance * (2.0 + scale.cwiseProduct(g).cwiseAbs().maxCoeff()));
}

void expect_gauss_newton(const CellProblem& problem, const Sums& sums, const VectorXd& weights) {
  const Layout at = problem.layout();
  const Expected expected{problem.jacobian(), weights, problem.residuals()};
  // Of smooth changes the velocity is quadratic within an interval to (omega h)^2 and less; omega depends on the
  // rotation vector to first order. With one coefficient it bends as sharply as it can, and with the turn omega h of
  // the axes it is off by as much of its own size; at the ends of the sweep little more than that is seen.
  expect_along(smooth_changes(at), sums, expected, problem.has_lever_arms ? 1e-2 : 1e-3);
  expect_along(single_changes(at), sums, expected, 1.5e-2);
  EXPECT_EQ(sums.g.segment(at.field, Layout::kBefore).norm(), 0.0) << "nothing of the map nor of stamps";
  EXPECT_EQ(sums.H.middleCols(at.field, Layout::kBefore).norm(), 0.0);
}

TEST(DopplerTerms, AreTheGaussNewtonSumsOfTheirEquation) {
  for (const bool has_lever_arms : {false, true}) {
    const CellProblem problem(7.3, has_lever_arms);
    ASSERT_GT(problem.weights().minCoeff(), 0.0);
    expect_gauss_newton(problem, sums_of(problem, problem.terms()), problem.weights());
  }
}

TEST(DopplerTerms, TellWhatAllOfAScanHaveInCommon) {
  CellProblem problem;
  for (DopplerCell& cell : problem.cells) {
    cell.s += 0.05;
  }
  const DopplerTerms::ScanError scan_error = sums_of(problem, problem.terms()).scan_error;
  // The mean of the residuals, drawn towards zero by its prior; and how it follows the unknowns.
  const VectorXd weights = problem.weights();
  const double variance = 1.0 / (weights.sum() + 1.0 / kScanVariance);
  EXPECT_NEAR(scan_error.value, variance * weights.dot(problem.residuals()), 1e-5);
  EXPECT_NEAR(scan_error.value, 0.05, 0.01);
  // Weights are taken at the sampled motion, those of the test at the exact one.
  EXPECT_NEAR(scan_error.variance, variance, 1e-4 * variance);
  const MatrixXd B = smooth_changes(problem.layout());
  const VectorXd by_unknowns = -variance * B.transpose() * problem.jacobian().transpose() * weights;
  EXPECT_LT((B.transpose() * scan_error.by_unknowns - by_unknowns).norm(), 1e-3 * by_unknowns.norm());
}

TEST(DopplerTerms, HoldInWhateverIntervalsTheyFall) {
  // The beginning of an interval is not exact: (i h) / h may be less than i.
  for (const int knot : {40, 48, 80, 88, 160, 312}) {
    SCOPED_TRACE(knot);
    const CellProblem problem((knot + 0.5) * kSpacing_s, false, 80);
    expect_gauss_newton(problem, sums_of(problem, problem.terms()), problem.weights());
  }
}

TEST(DopplerTerms, AreLinearisedWhereTheyAreAsked) {
  // Made at one trajectory and theta, added at others: the weights stay, the equation is that of the new ones.
  const CellProblem before;
  const DopplerTerms terms = before.terms();
  CellProblem after = before;
  for (std::size_t k = 0; k < after.trajectory.coefficients().size(); ++k) {
    const double t = kSpacing_s * static_cast<double>(k);
    Vector6d change;
    change << 0.01, 0.02 * t, -0.1 * t, 0.5 * t, 0.3 * t, -0.1 * t;
    after.trajectory.coefficients()[k] += change;
  }
  after.theta.array() += 0.01;
  expect_gauss_newton(after, sums_of(after, terms), before.weights());
}

TEST(DopplerTerms, ACellFarOffHasNoWeight) {
  CellProblem problem;
  const std::size_t far = 17;
  problem.cells[far].s += 3.0;
  ASSERT_EQ(problem.weights()[static_cast<Index>(far)], 0.0);
  const Sums with = sums_of(problem, problem.terms());
  CellProblem nearer = problem;
  nearer.cells[far].s += 4.0;
  const Sums farther = sums_of(nearer, nearer.terms());
  EXPECT_EQ(with.H, farther.H);
  EXPECT_EQ(with.g, farther.g);
  expect_gauss_newton(problem, with, problem.weights());
}

TEST(DopplerTerms, TheKernelWidensWithTheScatter) {
  // All cells are off by five of their standard deviations: that is the error of the state, not of the cells.
  CellProblem problem;
  for (std::size_t k = 0; k < problem.cells.size(); ++k) {
    problem.cells[k].s += k % 2 == 0 ? 0.25 : -0.25;
  }
  EXPECT_GT(problem.weights().minCoeff(), 0.0);
  expect_gauss_newton(problem, sums_of(problem, problem.terms()), problem.weights());
}

TEST(DopplerTerms, OfNoCellsAddNothing) {
  CellProblem problem;
  const DopplerTerms terms({}, {}, problem.state(), problem.stamp_s, kCellVariance, false, kOneThread);
  const Sums sums = sums_of(problem, terms);
  EXPECT_EQ(sums.H.norm(), 0.0);
  EXPECT_EQ(sums.g.norm(), 0.0);
  EXPECT_EQ(terms.unexplained_variance({}, {}, problem.state(), kOneThread), 0.0);
}

TEST(DopplerTerms, TellTheVarianceBeyondThatOfPoints) {
  CellProblem problem(7.3, false, 4000);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double unexplained = 0.04;
  for (DopplerCell& cell : problem.cells) {
    cell.s -= problem.residual(cell);
    cell.s += std::sqrt(1.0 / cell.weight + unexplained * unexplained) * normal(random);
  }
  const auto variance = [&] {
    return problem.terms().unexplained_variance(problem.cells, problem.columns(), problem.state(), kOneThread);
  };
  // Of normal errors the kernel, 4.5 standard deviations wide, holds back 0.185 of the whole variance, here 0.0029.
  EXPECT_NEAR(variance(), unexplained * unexplained - 0.185 * 0.0029, 0.1 * 0.0029);
  const double without = variance();
  for (DopplerCell& cell : problem.cells) {
    cell.s += 0.3;
  }
  problem.scan_error_mps = 0.3;
  EXPECT_NEAR(variance(), without, 1e-9) << "what the whole scan has in common is no error of cells";
  problem.scan_error_mps = 0.0;
  for (DopplerCell& cell : problem.cells) {
    cell.s -= problem.residual(cell);
    cell.s += 0.7 / std::sqrt(cell.weight) * normal(random);
  }
  EXPECT_EQ(variance(), 0.0);
}

}  // namespace
}  // namespace dynamic_icp::window
