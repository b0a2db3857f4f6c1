// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/window/window_estimator.hpp"

// What a scan tells of its noise and of the error of its sensor.
namespace dynamic_icp::window {
namespace {

// Of the newest scan in a mean over the last scans.
constexpr double kGain = 0.2;
constexpr double kMinCellVariance = 1e-6;
constexpr double kMaxCellVariance = 0.1;
constexpr double kMinModelSigma_m = 1e-3;

// The field walks by this share of its scale in so many scans.
constexpr int kWalkPeriod = 5;
constexpr double kWalkShare = 0.03;

// Its velocity-like part walks in each scan, and by a share of its scale with the distance driven.
constexpr double kVelocityWalk_mps = 0.002;
constexpr double kVelocityWalkShare_1_m = 0.1;

// Where a whole scan points looks like a rotation and confirms itself: it is never taken for larger.
constexpr double kStartPointing_rad = 3e-5;
constexpr double kMaxPointing_rad = 2e-4;

}  // namespace

LearnedVariance::Prior WindowEstimator::stamp_prior(double sigma_s) {
  return {.sigma = sigma_s, .counts = 2.0, .min_sigma = 1e-5, .max_sigma = 3e-3};
}

/// How regular scans come does not change, so the memory is long.
LearnedVariance::Prior WindowEstimator::period_prior(double sigma_s, double counts) {
  return {.sigma = sigma_s, .counts = counts, .min_sigma = 1e-5, .max_sigma = 0.05, .memory = 0.98};
}

LearnedVariance::Prior WindowEstimator::scan_error_prior(double sigma_mps) {
  return {.sigma = sigma_mps, .counts = 2.0, .min_sigma = 5e-4, .max_sigma = 0.5};
}

LearnedVariance::Prior WindowEstimator::pointing_prior() {
  return {.sigma = kStartPointing_rad, .counts = 2.0, .min_sigma = 1e-7, .max_sigma = kMaxPointing_rad};
}

/// A mirror face may sweep a whole scan; the sensors of a rig have none in common.
Eigen::Vector2d WindowEstimator::pointing_variance(const Scan& points) const {
  return Eigen::Vector2d::Constant(config_.learn_pointing && !points.is_of_rig() ? pointing_variance_.value() : 0.0);
}

/// The scales of the error field, from the covariance of the window.
void WindowEstimator::learn_field() {
  if (config_.learn_field) {
    field_covariance_root_ = elimination_.covariance_root(rest_factor_.head());
    field_->learn_scales(theta_, field_covariance_root_, hidden_azimuths_);
  }
}

/// How the sensor moves between two times.
void WindowEstimator::learn_motion(double from_s, double to_s) {
  motion_prior_.learn(trajectory_, trajectory_.interval(from_s), trajectory_.interval(to_s), rest_layout(),
                      rest_factor_);
}

/// How far stamps are off; by which share their variance grew. A scan shows the change from the last stamp to its own:
/// what stamps have in common drifts where Doppler and planes differ by a speed, and is no evidence.
double WindowEstimator::learn_stamps() {
  const Layout at = rest_layout();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(rest_factor_.size(), 2);
  rows(at.last_stamp(), 0) = -1.0;
  rows(at.stamp(), 0) = 1.0;
  rows(at.stamp(), 1) = 1.0;
  const Eigen::VectorXd variances = rest_factor_.covariance_root(rows).colwise().squaredNorm();
  const double before = stamp_variance_.value();
  const double growth = stamp_variance_.propose_change(stamp_errors_[1] - stamp_errors_[0], variances[0],
                                                       -last_stamp_.value, before + last_stamp_.variance);
  // The scan joins the past with the variance that it has now.
  this_stamp_ = with_prior({stamp_errors_[1], variances[1]}, before, stamp_variance_.value());
  return growth;
}

/// How regular the period of the scans is.
void WindowEstimator::learn_period() {
  if (!interval_) {
    return;
  }
  const Layout at = rest_layout();
  Eigen::MatrixXd row = Eigen::MatrixXd::Zero(rest_factor_.size(), 1);
  row(at.last_stamp(), 0) = -1.0;
  row(at.stamp(), 0) = 1.0;
  const double variance = rest_factor_.covariance_root(row).squaredNorm();
  period_variance_.propose(stamp_errors_[1] - stamp_errors_[0] - interval_->value, variance);
  period_variance_.keep();
}

/// And what all Doppler values of a scan have in common.
double WindowEstimator::learn_scan_errors() {
  if (!doppler_ || !config_.use_doppler) {
    return 0.0;
  }
  const Eigen::VectorXd by_rest = scan_error_.by_unknowns.tail(rest_factor_.size());
  const double variance = scan_error_.variance + rest_factor_.covariance_root(by_rest).squaredNorm();
  return scan_error_variance_.propose(scan_error_.value, variance);
}

/// And where all of a scan points: by its elevation, for an azimuth looks like a rotation.
void WindowEstimator::learn_pointing(const PlaneTerms& planes) {
  if (!config_.use_planes || !config_.learn_pointing) {
    return;
  }
  const PlaneTerms::ScanPointing scan = planes.scan_pointing(rest_layout());
  const Eigen::Vector2d variances =
      scan.variance + rest_factor_.covariance_root(scan.by_unknowns).colwise().squaredNorm().transpose();
  pointing_variance_.propose(scan.error[1], variances[1]);
}

/// How rough the surfaces are.
void WindowEstimator::learn_roughness(const PlaneQuality& planes) {
  if (planes.model_sigma_m) {
    const double seen = std::max(kMinModelSigma_m, *planes.model_sigma_m);
    const double variance = model_sigma_m_ * model_sigma_m_;
    model_sigma_m_ = std::sqrt(variance + kGain * (seen * seen - variance));
  }
}

/// What the points of a cell have in common.
void WindowEstimator::learn_cell_variance(const Workers& workers) {
  if (doppler_) {
    const double seen = std::clamp(doppler_->unexplained_variance(cells_.cells(), columns_, doppler_state(), workers),
                                   kMinCellVariance, kMaxCellVariance);
    cell_variance_ += (scans_ever_ == 0 ? 1.0 : kGain) * (seen - cell_variance_);
  }
}

/// The error of a sensor drifts. Its velocity-like part changes with the scene, too, and what planes say of it errs
/// alike while the same surfaces are in view: what they told counts less with the distance driven. A calibration was
/// learned among others and stays.
void WindowEstimator::walk_field(double distance_m) {
  if (!config_.learn_field) {
    return;
  }
  const double share = is_calibrated_ ? 0.0 : kVelocityWalkShare_1_m * distance_m;
  for (const DopplerErrorField::Group& group : field_->groups()) {
    const bool is_velocity = group.name == "velocity";
    if (!is_velocity && scans_ever_ % kWalkPeriod != 0) {
      continue;
    }
    const double sigma = is_velocity ? std::hypot(kVelocityWalk_mps, share * group.tau) : kWalkShare * group.tau;
    quadratic_->walk(static_cast<Eigen::Index>(group.begin), sigma * sigma * group.K);
  }
}

}  // namespace dynamic_icp::window
