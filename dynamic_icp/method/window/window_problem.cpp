// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include "dynamic_icp/method/base/replace.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// What a scan minimises: the terms of WindowEstimator, linearised.
namespace dynamic_icp::window {
namespace {

// The map errs as the sweeps in it, to so much.
constexpr double kTieRotation = 5e-6;
constexpr double kTiePosition_m = 2e-5;

// The first scan: its pose is the origin and its stamp is when time begins; its motion is unknown.
constexpr double kStartRotation = 1e-6;
constexpr double kStartPosition_m = 1e-5;
constexpr double kStartVelocity_mps = 50.0;
constexpr double kStartAlpha_rad_s2 = 1.0;
constexpr double kStartAcceleration_mps2 = 3.0;
constexpr double kStartStamp_s = 1e-6;

// (m/s)^2, of an error that is not looked for.
constexpr double kNoError = 1e-9;

Eigen::VectorXd tie_variances() {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(kTieRotation * kTieRotation),
      Eigen::Vector3d::Constant(kTiePosition_m * kTiePosition_m);
  return variances.replicate<Layout::kMapNodes, 1>();
}

}  // namespace

/// The past and the Doppler, on which theta acts, linearised at the state of the moment; theta is eliminated from them.
void WindowEstimator::linearise() {
  const Layout at = layout();
  replace(linear_H_, quadratic_->Q().topLeftCorner(at.head(), at.head()));
  if (doppler_ && config_.use_doppler) {
    doppler_->linearise(trajectory_);
    doppler_->add_information(at, scan_error_variance(), linear_H_);
  }
  Eigen::MatrixXd F = linear_H_.topLeftCorner(at.field, at.field);
  field_->add_prior_information(F);
  elimination_ = FieldElimination(F, linear_H_, config_.learn_field);
}

/// Their gradient, without the prior of theta.
Eigen::VectorXd WindowEstimator::linear_gradient() {
  const Layout at = layout();
  Eigen::VectorXd d(at.size());
  d.head(at.field) = theta_ - theta_0_;
  d.segment(at.map_error(), Layout::kMapError) = map_error_ - map_error_0_;
  d.segment<2>(at.last_stamp()) = stamp_errors_ - stamp_errors_0_;
  for (std::size_t k = 0; k < coefficients_0_.size(); ++k) {
    d.segment<6>(at.coefficient(k)) = trajectory_.coefficients()[k] - coefficients_0_[k];
    if (at.vibrates) {
      d.segment<6>(at.vibration(k)) = trajectory_.vibration()[k] - vibration_0_[k];
    }
  }
  Eigen::VectorXd g = quadratic_->g();
  g.noalias() += quadratic_->Q() * d;
  if (doppler_ && config_.use_doppler) {
    scan_error_ = doppler_->add_gradient(trajectory_, theta_, at, scan_error_variance(), g);
  }
  return g;
}

double WindowEstimator::scan_error_variance() const {
  return config_.learn_field ? scan_error_variance_.value() : kNoError;
}

/// What has nothing to do with theta: planes, the map's error, how the sensor moves, stamps.
WindowEstimator::Problem WindowEstimator::terms_of_rest(const PlaneTerms* planes, std::size_t first_new,
                                                        double stamp_variance) const {
  const Layout at = rest_layout();
  Problem problem{Eigen::MatrixXd::Zero(at.size(), at.size()), Eigen::VectorXd::Zero(at.size())};
  if (planes != nullptr) {
    planes->add(at, problem.H, problem.g);
  }
  motion_prior_.add(trajectory_, first_new, at, problem.H, problem.g);
  problem.H(at.stamp(), at.stamp()) += 1.0 / stamp_variance;
  problem.g[at.stamp()] += stamp_errors_[1] / stamp_variance;
  add_period(at, problem);
  return problem;
}

/// The time since the last scan is a whole number of periods, as far as those are regular.
void WindowEstimator::add_period(const Layout& at, Problem& problem) const {
  if (!interval_) {
    return;
  }
  const double information = 1.0 / (period_variance_.value() + interval_->variance);
  const double e = stamp_errors_[1] - stamp_errors_[0] - interval_->value;
  problem.H(at.stamp(), at.stamp()) += information;
  problem.H(at.last_stamp(), at.last_stamp()) += information;
  problem.H(at.stamp(), at.last_stamp()) -= information;
  problem.g[at.stamp()] += information * e;
  problem.g[at.last_stamp()] -= information * e;
}

/// The terms of the first scan: where and when it is, and what is known of its motion.
WindowEstimator::Problem WindowEstimator::start_terms(const WindowScan& scan, double omega_sigma_rad_s) const {
  Problem problem = terms_of_rest(nullptr, 0, kStartStamp_s * kStartStamp_s);
  const TrajectoryPoint point = trajectory_.at(scan.stamp_s);
  const double h = trajectory_.knot_spacing();
  const double x = (scan.stamp_s - trajectory_.interval_begin(point.first)) / h;
  const std::array<double, 4> curvature = {(1.0 - x) / (h * h), (3.0 * x - 2.0) / (h * h), (1.0 - 3.0 * x) / (h * h),
                                           x / (h * h)};
  const auto sigmas = [](double rotation, double position) {
    Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(position);
    return sigma;
  };
  const Layout at = rest_layout();
  const auto add = [&](const std::array<double, 4>& w, const Vector6d& sigma, const std::vector<Vector6d>& prior) {
    const Vector6d information = sigma.cwiseAbs2().cwiseInverse();
    Vector6d e = Vector6d::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      e += w[i] * (trajectory_.coefficients()[point.first + i] - prior[point.first + i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      problem.g.segment<6>(at.coefficient(point.first + i)) += w[i] * information.cwiseProduct(e);
      for (std::size_t j = 0; j < 4; ++j) {
        problem.H.block<6, 6>(at.coefficient(point.first + i), at.coefficient(point.first + j)).diagonal() +=
            (w[i] * w[j]) * information;
      }
    }
  };
  add(point.weight, sigmas(kStartRotation, kStartPosition_m), coefficients_0_);
  add(point.slope, sigmas(omega_sigma_rad_s, kStartVelocity_mps), coefficients_0_);
  add(curvature, sigmas(kStartAlpha_rad_s2, kStartAcceleration_mps2), coefficients_0_);
  return problem;
}

WindowEstimator::Problem WindowEstimator::scan_terms(const std::optional<PlaneTerms>& planes,
                                                     std::size_t first_new) const {
  Problem problem =
      terms_of_rest(config_.use_planes && planes ? &*planes : nullptr, first_new, stamp_variance_.value());
  if (scans_ == 1) {
    tie_map_to_first_sweep(problem);
  }
  return problem;
}

/// Rows of the rigid displacement, about the origin of the reference, of what is seen at a time; per coefficient.
Eigen::MatrixXd WindowEstimator::displacement_rows(double time_s, const Layout& layout) const {
  const TrajectoryPoint point = trajectory_.at(time_s);
  const Eigen::Matrix3d L = point.R * point.J;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, 6 * layout.coefficients);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto column = static_cast<Eigen::Index>(6 * (point.first + k));
    rows.block<3, 3>(0, column) = point.weight[k] * L;
    rows.block<3, 3>(3, column) = point.weight[k] * skew(point.p) * L;
    rows.block<3, 3>(3, column + 3) = point.weight[k] * Eigen::Matrix3d::Identity();
  }
  return rows;
}

/// The middle of the last sweep, displaced since it was added to the map.
LastSweep WindowEstimator::last_sweep() const {
  LastSweep last;
  last.map_age = map_age_;
  last.rows = displacement_rows(last_middle_s_, rest_layout());
  for (std::size_t k = 0; k < coefficients_0_.size(); ++k) {
    const Vector6d change = trajectory_.coefficients()[k] - coefficients_0_[k];
    last.displacement += last.rows.middleCols<6>(6 * static_cast<Eigen::Index>(k)) * change;
  }
  return last;
}

/// The same at the phases of a sweep at which the map's error has its nodes.
Eigen::MatrixXd WindowEstimator::sweep_rows(double begin_s, double end_s, const Layout& layout) const {
  Eigen::MatrixXd rows(Layout::kMapError, 6 * layout.coefficients);
  for (Eigen::Index j = 0; j < Layout::kMapNodes; ++j) {
    const double phase = static_cast<double>(j) / static_cast<double>(Layout::kMapNodes - 1);
    rows.middleRows<6>(6 * j) = displacement_rows(begin_s + phase * (end_s - begin_s), layout);
  }
  return rows;
}

/// The map begins with the first sweep.
void WindowEstimator::tie_map_to_first_sweep(Problem& problem) const {
  const Layout at = rest_layout();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(Layout::kMapError, at.size());
  rows.middleCols(at.coefficient(0), 6 * at.coefficients) =
      -sweep_rows(first_.stamp_s + first_.begin_s, first_.stamp_s + first_.end_s, at);
  rows.block(0, at.map_error(), Layout::kMapError, Layout::kMapError).setIdentity();
  problem.H.noalias() += rows.transpose() * tie_variances().cwiseInverse().asDiagonal() * rows;
}

/// The map takes in each sweep with its share. Were it the mean of the sweeps exactly, its error would be known the
/// better the more has faded, until the numbers do not hold it.
void WindowEstimator::take_in_sweep(double share) {
  quadratic_->mix_map_error(share, sweep_rows(stamp_s() + begin_s_, stamp_s() + end_s_, layout()));
  quadratic_->walk(layout().map_error(), tie_variances().asDiagonal());
  map_error_ *= 1.0 - share;
  map_age_ = share > 0.0 ? (1.0 - share) * (map_age_ + 1.0) : 0.0;  // where it took in none, no patch errs as the last
}

}  // namespace dynamic_icp::window
