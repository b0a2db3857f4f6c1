// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/ego_motion/doppler_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamic_icp/estimation/median.hpp"
#include "dynamic_icp/estimation/robust_kernel.hpp"

namespace dynamic_icp::ego_motion {
namespace {

constexpr std::size_t kCellsPerBlock = 256;
constexpr double kUnknowns = 7.0;

/// The sums of products that H and the gradient are made of; J = [u; dt u; -1].
struct Moments {
  double uu[3][6] = {};  // sum w dt^k u u^T, upper triangles, k = 0, 1, 2
  double u[2][3] = {};   // sum w dt^k u
  double w = 0.0;
  double eu[2][3] = {};  // sum w e dt^k u
  double e = 0.0;
};

/// Of rows at the reference time only the first of the sums over dt^k are not zero.
void add_instant(Moments& m, const Eigen::Vector3d& u, double w, double e) {
  const double wu[3] = {w * u[0], w * u[1], w * u[2]};
  m.uu[0][0] += wu[0] * u[0];
  m.uu[0][1] += wu[0] * u[1];
  m.uu[0][2] += wu[0] * u[2];
  m.uu[0][3] += wu[1] * u[1];
  m.uu[0][4] += wu[1] * u[2];
  m.uu[0][5] += wu[2] * u[2];
  for (int j = 0; j < 3; ++j) {
    m.u[0][j] += wu[j];
    m.eu[0][j] += e * wu[j];
  }
  m.w += w;
  m.e += w * e;
}

void add_timed(Moments& m, const Eigen::Vector3d& u, double dt, double w, double e) {
  const double uu[6] = {u[0] * u[0], u[0] * u[1], u[0] * u[2], u[1] * u[1], u[1] * u[2], u[2] * u[2]};
  const double w1 = w * dt;
  const double w2 = w1 * dt;
  for (int j = 0; j < 6; ++j) {
    m.uu[0][j] += w * uu[j];
    m.uu[1][j] += w1 * uu[j];
    m.uu[2][j] += w2 * uu[j];
  }
  for (int j = 0; j < 3; ++j) {
    m.u[0][j] += w * u[j];
    m.u[1][j] += w1 * u[j];
    m.eu[0][j] += w * e * u[j];
    m.eu[1][j] += w1 * e * u[j];
  }
  m.w += w;
  m.e += w * e;
}

Eigen::Matrix3d symmetric(const double (&a)[6]) {
  Eigen::Matrix3d matrix;
  matrix << a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5];
  return matrix;
}

Vector7d gradient_of(const Moments& m, bool has_bias) {
  Vector7d gradient;
  gradient.head<3>() = Eigen::Map<const Eigen::Vector3d>(m.eu[0]);
  gradient.segment<3>(3) = Eigen::Map<const Eigen::Vector3d>(m.eu[1]);
  gradient[6] = has_bias ? -m.e : 0.0;
  return gradient;
}

Matrix7d matrix_of(const Moments& m, bool has_bias) {
  Matrix7d H = Matrix7d::Zero();
  H.block<3, 3>(0, 0) = symmetric(m.uu[0]);
  H.block<3, 3>(0, 3) = symmetric(m.uu[1]);
  H.block<3, 3>(3, 0) = H.block<3, 3>(0, 3);
  H.block<3, 3>(3, 3) = symmetric(m.uu[2]);
  if (has_bias) {
    H.block<3, 1>(0, 6) = -Eigen::Map<const Eigen::Vector3d>(m.u[0]);
    H.block<3, 1>(3, 6) = -Eigen::Map<const Eigen::Vector3d>(m.u[1]);
    H.block<1, 6>(6, 0) = H.block<6, 1>(0, 6).transpose();
    H(6, 6) = m.w;
  }
  return H;
}

/// Residuals of one cell and what they say of the cell.
struct CellResiduals {
  std::vector<double> e;
  std::vector<double> w;
  double cell_weight = 1.0;
};

void judge_cell(const DopplerRows& rows, std::size_t cell, const Vector7d& x, const RobustScale& scale,
                CellResiduals& result) {
  const std::size_t begin = rows.first[cell];
  const std::size_t n = rows.first[cell + 1] - begin;
  result.e.resize(n);
  result.w.resize(n);
  double weight = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double e = residual(rows, begin + k, x);
    const double w = estimation::tukey_weight(e, scale.cutoff_mps);
    result.e[k] = e;
    result.w[k] = w;
    weight += w;
    sum += w * e;
  }
  result.cell_weight = 1.0;
  if (scale.surface_mps > 0.0 && weight > 1.0) {
    // The mean of a cell is known better than one point: what creeps below the noise of a point shows here.
    const double noise2 = scale.noise_mps * scale.noise_mps;
    const double variance = noise2 / weight + scale.surface_mps * scale.surface_mps;
    const double cutoff = scale.cutoff_mps / scale.noise_mps;
    result.cell_weight = estimation::tukey_weight(sum / weight, cutoff * std::sqrt(variance));
  }
}

void add_cell(const DopplerRows& rows, std::size_t cell, const RobustScale& scale, const CellResiduals& residuals,
              Moments& moments, FitSums& sums) {
  const double per_cutoff2 = 1.0 / (scale.cutoff_mps * scale.cutoff_mps);
  const std::size_t begin = rows.first[cell];
  for (std::size_t k = 0; k < residuals.e.size(); ++k) {
    const double e = residuals.e[k];
    const double w = residuals.cell_weight * residuals.w[k];
    if (w <= 0.0) {
      continue;
    }
    if (rows.takes_time) {
      add_timed(moments, rows.u[begin + k], rows.dt[begin + k], w, e);
    } else {
      add_instant(moments, rows.u[begin + k], w, e);
    }
    const double x2 = e * e * per_cutoff2;
    sums.weights += w;
    sums.slopes += residuals.cell_weight * (1.0 - x2) * (1.0 - 5.0 * x2);
    sums.inlier_squared += e * e;
    ++sums.inliers;
  }
}

/// H and the priors. psi' instead of the weights: in the tails of the kernel a residual that grows loses pull, so the
/// weights alone overstate what a step changes.
Matrix7d information_of(const FitSums& sums, const DopplerModel& model) {
  const double slope = sums.weights > 0.0 ? std::clamp(sums.slopes / sums.weights, 0.5, 1.0) : 1.0;
  Matrix7d information = slope * sums.H;
  information += model.information;
  return information;
}

}  // namespace

FitSums& FitSums::operator+=(const FitSums& other) {
  H += other.H;
  gradient += other.gradient;
  weights += other.weights;
  slopes += other.slopes;
  inlier_squared += other.inlier_squared;
  inliers += other.inliers;
  return *this;
}

FitSums sum_fit(const DopplerRows& rows, const Vector7d& x, const RobustScale& scale, bool has_bias,
                const Workers& workers, std::vector<Vector7d>* cell_gradients) {
  const double factor = 1.0 / (scale.noise_mps * scale.noise_mps);
  if (cell_gradients != nullptr) {
    cell_gradients->assign(rows.cells(), Vector7d::Zero());
  }
  return workers.sum_blocks(rows.cells(), kCellsPerBlock, FitSums{}, [&](std::size_t begin, std::size_t end) {
    FitSums sums;
    Moments moments;
    CellResiduals residuals;
    for (std::size_t cell = begin; cell < end; ++cell) {
      judge_cell(rows, cell, x, scale, residuals);
      const Vector7d before = cell_gradients != nullptr ? gradient_of(moments, has_bias) : Vector7d::Zero();
      add_cell(rows, cell, scale, residuals, moments, sums);
      if (cell_gradients != nullptr) {
        (*cell_gradients)[cell] = factor * (gradient_of(moments, has_bias) - before);
      }
    }
    sums.H = factor * matrix_of(moments, has_bias);
    sums.gradient = factor * gradient_of(moments, has_bias);
    return sums;
  });
}

FitStep solve_fit(const FitSums& sums, const Vector7d& x, const DopplerModel& model, double open_deviation_mps) {
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
  const double least = 1.0 / (open_deviation_mps * open_deviation_mps);
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

Matrix7d sandwich_covariance(const DopplerRows& rows, const FitSums& sums, const Eigen::Matrix3d& open,
                             const DopplerModel& model, const std::vector<Vector7d>& cell_gradients) {
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
  // Few sectors say little about their own scatter, none at all when they fit exactly: the scatter expected from
  // independent noise, H, counts like as many sectors as three times the unknowns.
  const double presumed = 3.0 * kUnknowns;
  scatter = (sectors * scatter + presumed * sums.H) / (sectors + presumed);
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

double noise_from_neighbours(const DopplerRows& rows, const Vector7d& x, double minimum_mps, double maximum_mps) {
  constexpr std::size_t kMostCells = 2000;
  constexpr std::size_t kEnough = 50;
  std::vector<double> sizes;
  sizes.reserve(kMostCells);
  const std::size_t stride = rows.cells() / kMostCells + 1;
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
  const double noise =
      sizes.size() < kEnough / 2 ? maximum_mps : estimation::kDeviationPerMad * estimation::median(std::move(sizes));
  return std::clamp(noise, minimum_mps, maximum_mps);
}

}  // namespace dynamic_icp::ego_motion
