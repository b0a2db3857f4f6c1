// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/window/learned_field.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// What was learned of a sensor, from one recording to another.
namespace dynamic_icp::window {
namespace {

// The first scan of a recording does not show all directions.
constexpr double kSameView_rad = 0.15;

std::string text_of(const FieldShape& shape, std::size_t sensor) {
  const FieldShape::View& view = shape.views[sensor];
  return fmt::format("{} sensor{}, {} lines, {} faces, azimuth {:.2f} to {:.2f} rad, elevation {:.2f} to {:.2f} rad",
                     shape.views.size(), shape.views.size() == 1 ? "" : "s", shape.lines(), shape.faces,
                     view.azimuth_first, view.azimuth_first + view.azimuth_span, view.elevation_first,
                     view.elevation_first + view.elevation_span);
}

/// Whether a sensor of the one shape may show the other in one scan.
bool may_show(const FieldShape& whole, const FieldShape& seen, std::size_t sensor) {
  const FieldShape::View& a = whole.views[sensor];
  const FieldShape::View& b = seen.views[sensor];
  const auto within = [](double first, double span, double other_first, double other_span) {
    return other_first > first - kSameView_rad && other_first + other_span < first + span + kSameView_rad;
  };
  return within(a.azimuth_first, a.azimuth_span, b.azimuth_first, b.azimuth_span) &&
         within(a.elevation_first, a.elevation_span, b.elevation_first, b.elevation_span);
}

// For so many scans a calibration counts that tells how regular they come.
constexpr double kCalibratedPeriods = 2.0;

}  // namespace

void WindowEstimator::set_calibration(const SensorCalibration& calibration) {
  if (!config_.learn_field) {
    throw UsageError("a calibration of the sensor has no effect where the error of the Doppler is not learned");
  }
  LearnedField learned = learned_field(calibration);
  theta_ = learned.theta;
  quadratic_.emplace(theta_.size(), 0, config_.learn_vibration);
  quadratic_->set_field(learned.information, learned.gradient);
  field_ = std::move(learned.field);
  stamp_variance_ = LearnedVariance(stamp_prior(calibration.stamp_sigma_s));
  period_variance_ = LearnedVariance(period_prior(calibration.period_sigma_s, kCalibratedPeriods));
  scan_error_variance_ = LearnedVariance(scan_error_prior(calibration.scan_error_mps));
  is_calibrated_ = true;
}

void WindowEstimator::check_calibration(std::size_t faces) const {
  const FieldShape& known = field_->shape();
  const FieldShape seen = DopplerErrorField::shape_of(cells_.cells(), faces);
  if (known.views.size() != seen.views.size() || known.faces != seen.faces || known.lines() < seen.lines()) {
    throw UsageError(fmt::format("the calibration is that of another sensor: {}; this one: {}", text_of(known, 0),
                                 text_of(seen, 0)));
  }
  for (std::size_t k = 0; k < seen.views.size(); ++k) {
    if (!may_show(known, seen, k)) {
      throw UsageError(fmt::format("the calibration is that of another sensor: {}; this one (number {}): {}",
                                   text_of(known, k), k, text_of(seen, k)));
    }
  }
}

std::optional<SensorCalibration> WindowEstimator::calibration() const {
  if (!field_ || !config_.learn_field || scans_ever_ == 0) {
    return std::nullopt;
  }
  SensorCalibration result;
  result.shape = field_->shape();
  WindowQuadratic known = *quadratic_;
  known.keep_field_only(0);
  const Eigen::Index n = layout().field;
  for (const DopplerErrorField::Group& group : field_->groups()) {
    SensorCalibration::Part part{std::string(group.name), group.tau, {}, {}};
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(group.begin + i);
      part.error_mps.push_back(theta_[at]);
      part.sigma_mps.push_back(field_covariance_root_.row(at).norm());
    }
    result.parts.push_back(std::move(part));
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    result.gradient.push_back(known.g()[i]);
    result.information.emplace_back();
    for (Eigen::Index j = 0; j <= i; ++j) {
      result.information.back().push_back(known.Q()(i, j));
    }
  }
  result.stamp_sigma_s = std::sqrt(stamp_variance_.value());
  result.period_sigma_s = std::sqrt(period_variance_.value());
  result.scan_error_mps = std::sqrt(scan_error_variance_.value());
  return result;
}

}  // namespace dynamic_icp::window
