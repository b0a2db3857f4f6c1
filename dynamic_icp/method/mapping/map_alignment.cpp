// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/mapping/map_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/mapping/patch_scatter.hpp"
#include "dynamic_icp/method/mapping/plane_fit.hpp"
#include "dynamic_icp/method/registration/gauss_newton.hpp"

namespace dynamic_icp::mapping {
namespace {

// The kernel narrows by this factor with each step.
constexpr double kNarrowing = 0.5;

// Patches tell of themselves when there are so many.
constexpr std::size_t kInformativePatches = 50;

// The wide kernel is given up when it is narrower than any surface is rough.
constexpr double kNarrow_m = 0.02;

// While the kernel is wide so many points are enough to narrow it, but no fewer than every fourth is asked.
constexpr std::size_t kCoarsePoints = 2500;
constexpr std::size_t kCoarsestStride = 4;

double largest_deviation(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff()));
}

/// The terms of the prior.
class PriorTerms {
 public:
  explicit PriorTerms(const MotionPrior& prior)
      : prior_(prior),
        motion_information_(prior.covariance.ldlt().solve(motion::Matrix9d::Identity())),
        translation_information_(prior.translation_covariance.ldlt().solve(Eigen::Matrix3d::Identity())) {}

  void add(const MapAlignment& at, Matrix12d& H, Vector12d& b) const {
    motion::Vector9d e;
    e << log_so3(at.T_map_sensor.linear() * prior_.R_map_sensor.transpose()), at.sweep.omega - prior_.sweep.omega,
        at.sweep.alpha - prior_.sweep.alpha;
    const motion::Vector9d gradient = motion_information_ * e;
    const auto place = [](Eigen::Index k) { return k < 3 ? k : k + 3; };  // the position stands between
    for (Eigen::Index row = 0; row < 9; ++row) {
      b[place(row)] += gradient[row];
      for (Eigen::Index column = 0; column < 9; ++column) {
        H(place(row), place(column)) += motion_information_(row, column);
      }
    }
    // e_t = t - fixed - R turned; a rotation d moves R turned by d x R turned.
    const Eigen::Vector3d turned = at.T_map_sensor.linear() * prior_.displacement_rotated;
    const Eigen::Vector3d e_t = at.T_map_sensor.translation() - prior_.displacement_fixed - turned;
    Eigen::Matrix<double, 3, 6> J;
    J << skew(turned), Eigen::Matrix3d::Identity();
    H.topLeftCorner<6, 6>() += J.transpose() * translation_information_ * J;
    b.head<6>() += J.transpose() * (translation_information_ * e_t);
  }

 private:
  const MotionPrior& prior_;
  motion::Matrix9d motion_information_;
  Eigen::Matrix3d translation_information_;
};

void move(MapAlignment& at, const Vector12d& step) {
  at.T_map_sensor.linear() = exp_so3(step.head<3>()) * at.T_map_sensor.linear();
  at.T_map_sensor.translation() += step.segment<3>(3);
  at.sweep.omega += step.segment<3>(6);
  at.sweep.alpha += step.segment<3>(9);
}

/// Fit and covariance, from the last sums with the narrow kernel.
void describe(MapAlignment& result, const PlaneFit& fit, const PlaneSums& sums, const PriorTerms& prior) {
  Matrix12d H = sums.H;
  result.geometry_information = H.topLeftCorner<6, 6>();
  Vector12d b = sums.b;
  prior.add(result, H, b);
  result.covariance = H.ldlt().solve(Matrix12d::Identity());
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.diverged = result.diverged || !result.covariance.allFinite();
  result.on_planes = fit.on_planes();
  result.matched = sums.weights;
  result.rms_m = sums.weights > 0.0 ? std::sqrt(sums.squares / sums.weights) : 0.0;
  result.chi = sums.weights > 0.0 ? std::sqrt(sums.chi_squares / sums.weights) : 0.0;
  const std::vector<PatchMean> means = fit.patch_means();
  if (means.size() >= kInformativePatches) {
    result.model_sigma_m = unexplained_sigma(means);
  }
}

}  // namespace

MapAlignment align_to_map(const Scan& scan, const PlaneMap& map, const MotionPrior& prior, const MapAlignConfig& config,
                          const Workers& workers) {
  const double turn_m =
      registration::typical_distance(scan) * largest_deviation(prior.covariance.topLeftCorner<3, 3>());
  const double move_m = largest_deviation(prior.translation_covariance);
  return align_to_map(scan, map, prior, prior.R_map_sensor, config.kernel * std::hypot(turn_m, move_m), config,
                      workers);
}

MapAlignment align_to_map(const Scan& scan, const PlaneMap& map, const MotionPrior& prior,
                          const Eigen::Matrix3d& R_start, double gate_m, const MapAlignConfig& config,
                          const Workers& workers) {
  MapAlignment result;
  result.points = scan.size();
  result.T_map_sensor.linear() = R_start;
  result.T_map_sensor.translation() = prior.displacement_fixed + R_start * prior.displacement_rotated;
  result.sweep = prior.sweep;

  PlaneFit fit(scan, map, workers);
  const PriorTerms prior_terms(prior);
  const PlaneNoise noise{config.min_sigma_m, config.model_sigma_m};
  const std::size_t coarse_stride = std::clamp<std::size_t>(scan.size() / kCoarsePoints, 1, kCoarsestStride);
  gate_m = std::min(config.max_gate_m, gate_m);
  PlaneSums sums;
  while (result.iterations < config.max_iterations && !result.converged) {
    const bool is_wide = gate_m >= kNarrow_m;
    fit.associate(result.T_map_sensor, result.sweep, is_wide ? coarse_stride : 1);
    sums = fit.linearise(noise, {config.kernel, is_wide ? gate_m : 0.0});
    Matrix12d H = sums.H;
    Vector12d b = sums.b;
    prior_terms.add(result, H, b);
    const Vector12d step = -H.ldlt().solve(b);
    if (!(step.norm() <= kMaxCoordinate_m)) {  // also when it is not finite
      result.diverged = true;
      break;
    }
    move(result, step);
    ++result.iterations;
    result.converged = !is_wide && step.head<3>().norm() < config.rotation_step_rad &&
                       step.segment<3>(3).norm() < config.translation_step_m;
    gate_m *= kNarrowing;
  }
  result.T_map_sensor.linear() =
      Eigen::Quaterniond(result.T_map_sensor.linear()).normalized().toRotationMatrix();  // many small steps
  if (!result.converged) {
    // Once converged, the last sums are those of the final pose but for a step within the tolerance.
    fit.associate(result.T_map_sensor, result.sweep, 1);
    sums = fit.linearise(noise, {config.kernel, 0.0});
  }
  describe(result, fit, sums, prior_terms);
  return result;
}

Eigen::Matrix3d position_information_of_noise(const Scan& scan, const PlaneMap& map, const MapAlignment& found,
                                              const MapAlignConfig& config, const Workers& workers) {
  PlaneFit fit(scan, map, workers);
  fit.associate(found.T_map_sensor, found.sweep, 1);
  return fit.position_information_of_noise({config.min_sigma_m, config.model_sigma_m}, {config.kernel, 0.0});
}

motion::RotationState rotation_state(const MapAlignment& found) {
  motion::RotationState state;
  state.R_map_sensor = found.T_map_sensor.linear();
  state.omega = found.sweep.omega;
  state.alpha = found.sweep.alpha;
  constexpr std::array<int, 9> kRows = {0, 1, 2, 6, 7, 8, 9, 10, 11};  // all but the position
  state.covariance = found.covariance(kRows, kRows);
  return state;
}

}  // namespace dynamic_icp::mapping
