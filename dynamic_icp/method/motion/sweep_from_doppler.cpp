// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_from_doppler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/motion/sweep_times.hpp"

namespace dynamic_icp::motion {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Matrix34d = Eigen::Matrix<double, 3, 4>;
using Matrix45d = Eigen::Matrix<double, 4, 5>;

// Places of the columns in SweepSums::products.
constexpr Eigen::Index kVelocity = 0;
constexpr Eigen::Index kBias = 3;
constexpr Eigen::Index kChange = 4;  // three for each order
constexpr Eigen::Index kDoppler = 10;

constexpr double kMaxInterval = 1.6;  // of the period
constexpr std::size_t kMinScans = 6;

// The velocities that make the accelerations are those in the middle of sweeps once the sweep is known.
constexpr int kRounds = 4;

/// A scan with its velocity eliminated: what it says of [change of velocity over the scan (m/s); bias (m/s)].
struct Reduced {
  double time_s = 0.0;
  double points = 0.0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, where both are zero
  Matrix34d velocity_slope = Matrix34d::Zero();        ///< what both take away from it
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  double squares = 0.0;  ///< (m/s)^2, of the residuals where both are zero

  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2, by the velocities around
  bool is_amid_others = false;                             ///< there are two scans before and two after

  /// [change; bias] by the unknowns [D; c; b].
  [[nodiscard]] Matrix45d jacobian() const {
    Matrix45d J = Matrix45d::Zero();
    J.topLeftCorner<3, 1>() = acceleration;
    J.rightCols<4>().setIdentity();
    return J;
  }
};
using Stretch = std::vector<Reduced>;

Reduced reduced(const SweepSums& scan, PointOrder order) {
  const Eigen::Index change = kChange + (order == PointOrder::kAzimuth ? 0 : 3);
  const std::array<Eigen::Index, 3> gone = {kVelocity, kVelocity + 1, kVelocity + 2};
  const std::array<Eigen::Index, 5> kept = {change, change + 1, change + 2, kBias, kDoppler};
  const Eigen::Matrix<double, 3, 5> mixed = scan.products(gone, kept);
  const Eigen::Matrix<double, 3, 5> solved = Eigen::Matrix3d(scan.products(gone, gone)).ldlt().solve(mixed);
  const Matrix5d left = scan.products(kept, kept) - mixed.transpose() * solved;
  Reduced result;
  result.time_s = scan.time_s;
  result.points = scan.products(kBias, kBias);
  result.velocity = solved.col(4);
  result.velocity_slope = solved.leftCols<4>();
  result.information = left.topLeftCorner<4, 4>();
  result.gradient = left.topRightCorner<4, 1>();
  result.squares = left(4, 4);
  return result;
}

/// w_j with sum w_j f(t_j) = f'(t_at) for every polynomial f of degree four: the derivatives of Lagrange's polynomials.
std::array<double, 5> derivative_weights(std::span<const Reduced> five, std::size_t at) {
  std::array<double, 5> weights{};
  const auto between = [&](std::size_t a, std::size_t b) { return five[b].time_s - five[a].time_s; };
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (j == at) {
      continue;
    }
    weights[j] = 1.0 / between(at, j);
    for (std::size_t m = 0; m < weights.size(); ++m) {
      if (m != j && m != at) {
        weights[j] *= between(m, at) / between(m, j);
      }
    }
    weights[at] += 1.0 / between(j, at);
  }
  return weights;
}

/// Accelerations by the velocities of the five nearest scans, where the change over a scan is D a + c and the bias b.
void set_accelerations(Stretch& stretch, const Vector5d& unknowns, double period_s) {
  constexpr std::size_t kFive = 5;
  if (stretch.size() < kFive) {
    return;
  }
  std::vector<Eigen::Vector3d> velocities;
  for (const Reduced& scan : stretch) {
    velocities.emplace_back(scan.velocity - scan.velocity_slope * (scan.jacobian() * unknowns));
  }
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    const std::size_t first = std::min(k > 2 ? k - 2 : 0, stretch.size() - kFive);
    const std::span<const Reduced> five(&stretch[first], kFive);
    bool has_gap = false;
    for (std::size_t j = 1; j < kFive; ++j) {
      has_gap = has_gap || !(five[j].time_s - five[j - 1].time_s <= kMaxInterval * period_s);
    }
    stretch[k].is_amid_others = !has_gap && k == first + 2;
    stretch[k].acceleration.setZero();
    const std::array<double, kFive> weights = derivative_weights(five, k - first);
    for (std::size_t j = 0; j < kFive && !has_gap; ++j) {
      stretch[k].acceleration += weights[j] * velocities[first + j];
    }
  }
}

/// The least squares over all scans that are amid others.
struct Solution {
  Vector5d unknowns = Vector5d::Zero();  ///< [D; c; b]
  Matrix5d inverse = Matrix5d::Zero();   ///< of the normal equations: the covariance over the variance of the noise
  Matrix5d scatter = Matrix5d::Zero();   ///< sum over the scans of the products of their gradients
  double noise_variance = 0.0;           ///< (m/s)^2, of the Doppler of one point
  std::size_t scans = 0;
};

Solution solve(const std::vector<Stretch>& stretches) {
  std::vector<const Reduced*> scans;
  for (const Stretch& stretch : stretches) {
    for (const Reduced& scan : stretch) {
      if (scan.is_amid_others) {
        scans.push_back(&scan);
      }
    }
  }
  Solution solution;
  solution.scans = scans.size();
  Matrix5d H = Matrix5d::Zero();
  Vector5d g = Vector5d::Zero();
  double squares = 0.0;
  double points = 0.0;
  for (const Reduced* scan : scans) {
    const Matrix45d J = scan->jacobian();
    H += J.transpose() * scan->information * J;
    g += J.transpose() * scan->gradient;
    squares += scan->squares;
    points += scan->points;
  }
  solution.inverse = H.ldlt().solve(Matrix5d::Identity());
  solution.unknowns = solution.inverse * g;
  solution.noise_variance = (squares - solution.unknowns.dot(g)) / points;
  for (const Reduced* scan : scans) {
    const Matrix45d J = scan->jacobian();
    const Vector5d left = J.transpose() * (scan->gradient - scan->information * (J * solution.unknowns));
    solution.scatter += left * left.transpose();
  }
  return solution;
}

}  // namespace

SweepSums sweep_sums(const RawScan& raw, const Scan& scan, std::span<const std::uint32_t> rows, double time_s,
                     const Workers& workers) {
  const std::vector<double> by_azimuth = declared_times(raw.points, {.declared_duration_s = 1.0});
  const std::vector<double> as_stored =
      declared_times(raw.points, {.declared_duration_s = 1.0, .declared_as_stored = true});
  const auto products = [&](std::size_t begin, std::size_t end) {
    SweepSums::Matrix block = SweepSums::Matrix::Zero();
    Eigen::Matrix<double, 11, 1> columns;
    for (const std::uint32_t row : rows.subspan(begin, end - begin)) {
      const std::uint32_t record = scan.records()[row];
      const Eigen::Vector3d direction = -scan.directions()[row];
      columns << direction, 1.0, direction * (by_azimuth[record] - 0.5), direction * (as_stored[record] - 0.5),
          scan.doppler()[row];
      block.selfadjointView<Eigen::Lower>().rankUpdate(columns);
    }
    return SweepSums::Matrix(block.selfadjointView<Eigen::Lower>());
  };
  return {time_s, workers.sum_blocks(rows.size(), kPointBlock, SweepSums::Matrix::Zero().eval(), products)};
}

SweepDuration sweep_duration(std::span<const std::vector<SweepSums>> stretches, PointOrder order, double period_s) {
  std::vector<Stretch> scans;
  for (const std::vector<SweepSums>& stretch : stretches) {
    Stretch& reduced_stretch = scans.emplace_back();
    for (const SweepSums& scan : stretch) {
      reduced_stretch.push_back(reduced(scan, order));
    }
  }
  Solution solution;
  for (int round = 0; round < kRounds; ++round) {
    Vector5d unknowns = solution.unknowns;
    unknowns[0] = std::clamp(unknowns[0], -period_s, period_s);
    for (Stretch& stretch : scans) {
      set_accelerations(stretch, unknowns, period_s);
    }
    solution = solve(scans);
    if (solution.scans < kMinScans) {
      return {};
    }
  }
  // The scatter of few scans about their own fit is too small.
  const double few = static_cast<double>(solution.scans) / static_cast<double>(solution.scans - 2);
  const double by_noise = solution.noise_variance * solution.inverse(0, 0);
  const double by_scatter = few * solution.inverse.row(0).dot(solution.scatter * solution.inverse.col(0));
  SweepDuration duration;
  if (std::isfinite(solution.unknowns[0]) && by_noise > 0.0) {
    duration.duration_s = solution.unknowns[0];
    duration.sigma_s = std::sqrt(std::max(by_noise, by_scatter));
    duration.explained = duration.duration_s * duration.duration_s / by_noise;
  }
  return duration;
}

}  // namespace dynamic_icp::motion
