// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// What the estimator remembers from scan to scan. The rest is laid anew with each scan: its cells and their averages,
// the Doppler terms, the factors of the normal equations.
namespace dynamic_icp::window {

void WindowEstimator::state(StateArchive& archive) {
  field_state(archive);
  archive(trajectory_, theta_, map_error_, coefficients_0_, vibration_0_, theta_0_, map_error_0_, stamp_errors_,
          stamp_errors_0_, cells_, field_covariance_root_, motion_prior_, pointing_variance_, stamp_variance_,
          last_stamp_.value, last_stamp_.variance, this_stamp_.value, this_stamp_.variance, period_, period_variance_,
          scan_error_variance_, cell_variance_, model_sigma_m_);
  archive(twist_.angular, twist_.linear, twist_.covariance, stamp_s_, begin_s_, end_s_, first_.stamp_s, first_.begin_s,
          first_.end_s, scans_, scans_ever_, is_calibrated_);
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
    field_.emplace(shape);
    quadratic_.emplace(0, 0, config_.learn_vibration);
  }
  for (DopplerErrorField::Group& group : field_->groups()) {
    archive(group.tau);
  }
  archive(*quadratic_);
}

}  // namespace dynamic_icp::window
