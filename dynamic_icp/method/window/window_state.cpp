// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/window/learned_field.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// What the estimator remembers from scan to scan. The rest is laid anew with each scan: its cells and their averages,
// the Doppler terms, the factors of the normal equations.
namespace dynamic_icp::window {
namespace {

constexpr double kLongestSweep_s = 4.0 * kMaxPointTime_s;
constexpr int kManyScans = 1 << 30;

/// Whether a matrix may be a sum of x x^T, but for what rounding does to a singular one.
bool is_sum_of_squares(const Matrix6d& sum) {
  constexpr double kRounding = 1e-9;
  return Matrix6d(sum + kRounding * sum.trace() * Matrix6d::Identity()).ldlt().isPositive();
}

}  // namespace

void WindowEstimator::state(StateArchive& archive) {
  field_state(archive);
  archive(trajectory_, theta_, map_error_, coefficients_0_, vibration_0_, theta_0_, map_error_0_, stamp_errors_,
          stamp_errors_0_, cells_, field_covariance_root_, motion_prior_, pointing_variance_, stamp_variance_,
          last_stamp_.value, last_stamp_.variance, this_stamp_.value, this_stamp_.variance, period_, period_variance_,
          scan_error_variance_, cell_variance_, model_sigma_m_, map_age_, shown_motions_.all, shown_motions_.noise);
  archive(twist_.angular, twist_.linear, twist_.covariance, stamp_s_, begin_s_, end_s_, first_.stamp_s, first_.begin_s,
          first_.end_s, scans_, scans_ever_, is_calibrated_);
  bodies_.state(archive, field_ ? field_->size() : 0);
  check_read(archive);
}

/// Whether the parts fit each other.
void WindowEstimator::check_read(const StateArchive& archive) const {
  const auto is_sweep = [](double begin_s, double end_s) {
    return std::abs(begin_s) <= kLongestSweep_s && std::abs(end_s) <= kLongestSweep_s && begin_s <= end_s;
  };
  archive.require(scans_ >= 0 && scans_ <= scans_ever_ && scans_ever_ < kManyScans, "the number of scans");
  archive.require(is_sweep(begin_s_, end_s_) && is_sweep(first_.begin_s, first_.end_s) &&
                      stamp_errors_.cwiseAbs().maxCoeff() <= kLongestSweep_s,
                  "a time of a scan");
  archive.require(map_error_.size() == Layout::kMapError && cell_variance_ >= 0.0 && map_age_ >= 0.0,
                  "the error of the map");
  archive.require(is_sum_of_squares(shown_motions_.all) && is_sum_of_squares(shown_motions_.noise),
                  "what planes show of motions");
  archive.require(field_.has_value() || (scans_ever_ == 0 && !is_calibrated_), "the error field");
  if (!field_) {
    return;
  }
  const auto field_size = static_cast<Eigen::Index>(field_->size());
  archive.require(theta_.size() == field_size && quadratic_->layout().field == field_size &&
                      (scans_ever_ == 0 || !config_.learn_field || field_covariance_root_.rows() == field_size),
                  "the size of the error field");
  archive.require(quadratic_->layout().coefficients == static_cast<Eigen::Index>(trajectory_.coefficients().size()),
                  "the size of what past scans say");
  if (scans_ > 0) {
    const double stamp_s = stamp_s_ + stamp_errors_[1];
    archive.require(trajectory_.spans(stamp_s + std::min(0.0, begin_s_), stamp_s_ + std::max(0.0, end_s_)),
                    "the time of the trajectory");
  }
}

/// The field is made of its shape; of its parts only the scales were learned.
void WindowEstimator::field_state(StateArchive& archive) {
  bool is_there = field_.has_value();
  archive(is_there);
  if (!is_there) {
    field_.reset();
    quadratic_.reset();
    return;
  }
  FieldShape shape = field_ ? field_->shape() : FieldShape{};
  archive.each(shape.views, [&](FieldShape::View& view) {
    archive(view.azimuth_first, view.azimuth_span, view.elevation_first, view.elevation_span);
  });
  archive(shape.line_elevations_rad, shape.faces, shape.intensity_mean, shape.intensity_scale);
  if (archive.reads()) {
    archive.require(is_possible(shape) && std::ranges::all_of(shape.views,
                                                              [](const FieldShape::View& view) {
                                                                return view.azimuth_span > 0.0 &&
                                                                       view.elevation_span > 0.0;
                                                              }),
                    "the shape of the error field");
    field_.emplace(shape);
    quadratic_.emplace(0, 0, config_.learn_vibration);
  }
  for (DopplerErrorField::Group& group : field_->groups()) {
    archive(group.tau);
    archive.require(group.tau >= 0.0, "a scale of the error field");
  }
  archive(*quadratic_);
}

}  // namespace dynamic_icp::window
