// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/doppler_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr double kUnknowns = 7.0;
constexpr double kFloorMps = 1e-3;  // errors of all lines of sight together: 0.003 degrees at 20 m/s
constexpr double kJerk = 10.0;      // m/s^3, of hard braking and steering

/// H and the priors. psi' instead of the weights: in the tails of the kernel a residual that grows loses pull, so the
/// weights alone overstate what a step changes.
Matrix7d information_of(const FitSums& sums, const DopplerModel& model) {
  const double slope = sums.weights > 0.0 ? std::clamp(sums.slopes / sums.weights, 0.5, 1.0) : 1.0;
  Matrix7d information = slope * sums.H;
  information += model.information;
  return information;
}

}  // namespace

FitStep solve_fit(const FitSums& sums, const Vector7d& x, const DopplerModel& model, double unobservable_sigma_mps) {
  FitStep result;
  const Matrix7d information = information_of(sums, model);
  const Vector7d gradient = sums.gradient + model.information * (x - model.prior);

  // v alone, after the others are solved for (Schur's complement); their block is definite thanks to the priors.
  const Eigen::Matrix4d others = information.bottomRightCorner<4, 4>();
  const Eigen::LDLT<Eigen::Matrix4d> others_solver(others);
  const Eigen::Matrix<double, 4, 3> coupling = information.bottomLeftCorner<4, 3>();
  const Eigen::Matrix3d marginal =
      information.topLeftCorner<3, 3>() - coupling.transpose() * others_solver.solve(coupling);
  const Eigen::Vector3d rest = gradient.head<3>() - coupling.transpose() * others_solver.solve(gradient.tail<4>());

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(marginal);
  const double least = 1.0 / (unobservable_sigma_mps * unobservable_sigma_mps);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()[k] > least) {
      result.step.head<3>() -= axis * (axis.dot(rest) / eigen.eigenvalues()[k]);
    } else {
      result.open += axis * axis.transpose();
    }
  }
  result.step.tail<4>() = -others_solver.solve(gradient.tail<4>() + coupling * result.step.head<3>());
  return result;
}

Matrix7d gradient_scatter(const DopplerRows& rows, const Matrix7d& H, const std::vector<Vector7d>& cell_gradients) {
  std::vector<Vector7d> by_sector(rows.sectors, Vector7d::Zero());
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    by_sector[rows.sector[c]] += cell_gradients[c];
  }
  Matrix7d scatter = Matrix7d::Zero();
  double sectors = 0.0;
  for (const Vector7d& gradient : by_sector) {
    scatter += gradient * gradient.transpose();
    sectors += gradient.isZero(0.0) ? 0.0 : 1.0;
  }
  const double presumed = 3.0 * kUnknowns;
  return (sectors * scatter + presumed * H) / (sectors + presumed);
}

Matrix7d sandwich_covariance(const DopplerRows& rows, const FitSums& sums, const Eigen::Matrix3d& open,
                             const DopplerModel& model, const std::vector<Vector7d>& cell_gradients) {
  Matrix7d scatter = gradient_scatter(rows, sums.H, cell_gradients);
  scatter += model.information;

  const Matrix7d information = information_of(sums, model);
  // Along open directions: an information so large that nothing comes out.
  Matrix7d keep = Matrix7d::Identity();
  keep.topLeftCorner<3, 3>() -= open;
  Matrix7d closed = keep * information * keep;
  closed.topLeftCorner<3, 3>() += open * std::max(1.0, information.topLeftCorner<3, 3>().trace());
  const Eigen::LDLT<Matrix7d> solver(closed);
  const Matrix7d half = solver.solve(keep * scatter * keep);
  Matrix7d covariance = solver.solve(half.transpose());
  covariance = keep * covariance * keep;
  return 0.5 * (covariance + covariance.transpose());
}

double floor_variance(double duration_s) {
  // A jerk j leaves j dt^2/2 unexplained, j T^2/24 on average over a sweep of duration T.
  const double unexplained = kJerk * duration_s * duration_s / 24.0;
  return kFloorMps * kFloorMps + unexplained * unexplained;
}

double noise_from_neighbours(const DopplerRows& rows, const Vector7d& x, double minimum_mps, double maximum_mps) {
  constexpr std::size_t kMaxCells = 2000;
  constexpr std::size_t kEnough = 50;
  std::vector<double> sizes;
  sizes.reserve(kMaxCells);
  const std::size_t stride = rows.cells() / kMaxCells + 1;
  for (std::size_t c = 0; c < rows.cells(); c += stride) {
    const std::size_t begin = rows.first[c];
    if (rows.first[c + 1] - begin >= 2) {
      sizes.push_back(std::abs(residual(rows, begin, x) - residual(rows, begin + 1, x)) * std::sqrt(0.5));
    }
  }
  if (sizes.size() < kEnough) {
    sizes.clear();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      sizes.push_back(std::abs(residual(rows, i, x)));
    }
  }
  // The median of a handful of residuals that were just fitted says nothing.
  const double noise = sizes.size() < kEnough / 2 ? maximum_mps : kSigmaPerMad * median(std::move(sizes));
  return std::clamp(noise, minimum_mps, maximum_mps);
}

}  // namespace dynamic_icp::ego_motion
