// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "dynamic_icp/method/tracking/cluster_velocity.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kTrim = 0.02;   // share of points beyond the sides of a box
constexpr double kGrowth = 0.3;  // of a box, towards a larger one seen: noise must not make it grow
constexpr double kKnownDirection_rad = 0.35;
// A box made when the direction was known worse than this is made anew as soon as it is known so much better.
constexpr double kGoodDirection_rad = 0.03;
constexpr double kBetterDirection = 0.7;
constexpr double kYawSearch_rad = 0.35;
constexpr double kShortestSide_m = 1.0;  // sides shorter than this have no direction
constexpr double kFirstYawSigma_rad = 0.1;
constexpr double kYawFloor_mps = 0.1;
constexpr double kLogUnlikely = -3.0;  // that a thing does not move along its sides
constexpr double kLogUsual = -2.5;     // of the three corrections of a box that is in order
constexpr double kWidthSigma_m = 0.5;
constexpr double kUsableDirection_rad = 0.15;  // boxes with a direction known worse do not keep their sizes
constexpr double kEndOn = 0.25;                // part of an axis across the line of sight, below which it is end-on
constexpr double kDimSpeed_mps = 0.5;
constexpr double kEndDepth_m = 0.3;  // points so near to the end of a span make the end
constexpr double kLookBeyond_m = 0.4;
constexpr double kOccluderClearance_m = 1.0;
constexpr double kWorstLog = -10.0;
constexpr double kOwnSpeed_mps = 1.0;  // slower things have no direction of motion

MotionFilter prior(const Vector3d& position, const TrackConfig& config) {
  MotionFilter::Vector7d state = MotionFilter::Vector7d::Zero();
  state.head<3>() = position;
  MotionFilter::Vector7d sigmas;
  sigmas << 1.0, 1.0, 1.0, config.prior_speed_mps, config.prior_speed_mps, config.prior_climb_mps,
      config.prior_yaw_rate_rps;
  return {state, sigmas.cwiseAbs2().asDiagonal()};
}

Vector3d mean_of(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace

BoxFilter::BoxFilter(const Detection& detection, std::optional<double> yaw_rad, const TrackConfig& config)
    : motion_(prior(mean_of(detection.points), config)), moves_along_sides_(yaw_rad.has_value()) {
  correct_doppler(detection, config);
  if (yaw_rad) {
    const double speed = motion_.velocity().head<2>().norm();
    const double sigma = kFirstYawSigma_rad * speed + kYawFloor_mps;
    log_likelihood_ += motion_.correct_velocity(upright_axes(*yaw_rad).col(1), 0.0, sigma * sigma);
    const bool backwards = upright_axes(*yaw_rad).col(0).dot(motion_.velocity()) < 0.0;
    yaw_ = *yaw_rad + (backwards ? std::numbers::pi : 0.0);
  } else {
    yaw_ = std::atan2(motion_.velocity().y(), motion_.velocity().x());
    log_likelihood_ += kLogUnlikely;
  }
  make_box(at_mean_time(detection, motion_.velocity()), config);
}

void BoxFilter::predict(double dt_s, const TrackConfig& config) {
  yaw_ += motion_.yaw_rate() * dt_s;
  motion_.predict(dt_s, config.motion);
}

void BoxFilter::correct(const Detection& detection, const TrackConfig& config) {
  correct_doppler(detection, config);
  const Detection now = at_mean_time(detection, motion_.velocity());
  follow_direction();
  if (moves_along_sides_) {
    correct_yaw(now, config);
    follow_direction();
  }
  if (box_sigma_rad_ > kGoodDirection_rad && direction_sigma() < kBetterDirection * box_sigma_rad_) {
    make_box(now, config);
    log_likelihood_ += kLogUsual;
  } else {
    correct_box(now, config);
  }
}

OrientedBox BoxFilter::box() const { return {motion_.position(), upright_axes(yaw_), size_}; }

double BoxFilter::direction_sigma() const {
  const Eigen::Vector2d v = motion_.velocity().head<2>();
  const double speed = v.norm();
  if (speed < kOwnSpeed_mps) {
    return std::numbers::pi;
  }
  const Eigen::Vector2d across(-v.y() / speed, v.x() / speed);
  return std::sqrt(across.dot(motion_.covariance().block<2, 2>(3, 3) * across)) / speed;
}

void BoxFilter::correct_doppler(const Detection& detection, const TrackConfig& config) {
  const ClusterVelocity measured =
      fit_cluster_velocity(detection.directions, detection.radial, config.doppler_sigma_mps);
  spread_mps_ = measured.spread_mps;
  signal_mps_ = measured.signal_mps;
  // Roll and pitch of the body look like a vertical velocity, the more the farther it is.
  const double sway = config.sway_rps * (motion_.position() - detection.sensor).norm();
  Eigen::Matrix3d floor = config.doppler_floor_mps * config.doppler_floor_mps * Eigen::Matrix3d::Identity();
  floor(2, 2) += sway * sway;
  log_likelihood_ += motion_.correct_doppler(measured, detection.sensor, floor);
}

/// Vehicles move where their sides point.
void BoxFilter::correct_yaw(const Detection& detection, const TrackConfig& config) {
  const std::optional<double> fitted = fit_yaw(detection.points, yaw_, kYawSearch_rad);
  if (!fitted || motion_.velocity().head<2>().norm() < kOwnSpeed_mps) {
    return;
  }
  const Eigen::Matrix3d axes = upright_axes(*fitted);
  const double side = std::max(span_along(detection.points, motion_.position(), axes.col(0), kTrim).length(),
                               span_along(detection.points, motion_.position(), axes.col(1), kTrim).length());
  if (side < std::max(kShortestSide_m, config.vehicle_width_m)) {
    return;
  }
  const double range = (motion_.position() - detection.sensor).norm();
  const double sigma =
      std::hypot(config.yaw_sigma_rad, (config.face_sigma_m + config.face_sigma_growth * range) / side);
  const double speed = motion_.velocity().head<2>().norm();
  const double sigma_mps = sigma * speed + 0.1;
  log_likelihood_ += motion_.correct_velocity(axes.col(1), 0.0, sigma_mps * sigma_mps);
}

void BoxFilter::follow_direction() {
  if (direction_sigma() < kKnownDirection_rad) {
    const Vector3d v = motion_.velocity();
    yaw_ = std::atan2(v.y(), v.x());
  }
}

/// Whether a body ends at `end`, as seen from the sensor: nothing hides what would come next.
bool BoxFilter::is_true_end(const Vector3d& end, const Vector3d& outward, const Detection& detection) const {
  const Vector3d to_end = end - detection.sensor;
  const double range = to_end.norm();
  const Vector3d sight = to_end / range;
  const Vector3d sideways = outward - outward.dot(sight) * sight;
  if (sideways.norm() < kEndOn) {
    return outward.dot(sight) < 0.0;  // the near end of what is seen end-on; the body hides the far one
  }
  // Points of the body that hardly move along the line of sight are missing among the moving ones.
  if (std::abs(sight.dot(motion_.doppler_velocity(detection.sensor))) < kDimSpeed_mps) {
    return false;
  }
  if (detection.view == nullptr) {
    return true;
  }
  const double cell = range * RangeImage::cell_width();
  for (const double step : {cell, std::max(kLookBeyond_m, 2.0 * cell)}) {
    const Vector3d beyond = detection.T_sensor_world * (end + step * sideways.normalized());
    if (detection.view->hides(beyond, kOccluderClearance_m)) {
      return false;
    }
  }
  return true;
}

AxisView BoxFilter::look_along(int axis, const Detection& detection) const {
  const Vector3d direction = upright_axes(yaw_).col(axis);
  AxisView view{span_along(detection.points, motion_.position(), direction, kTrim)};
  if (axis == 2) {
    return view;
  }
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  double low_count = 0.0;
  double high_count = 0.0;
  for (const Vector3d& point : detection.points) {
    const double q = (point - motion_.position()).dot(direction);
    if (q <= view.seen.low + kEndDepth_m) {
      low += point;
      low_count += 1.0;
    }
    if (q >= view.seen.high - kEndDepth_m) {
      high += point;
      high_count += 1.0;
    }
  }
  view.low_end = is_true_end(low / low_count, -direction, detection);
  view.high_end = is_true_end(high / high_count, direction, detection);
  return view;
}

/// The box from this detection and, where ends are hidden, what is known of its size.
void BoxFilter::make_box(const Detection& detection, const TrackConfig& config) {
  const Eigen::Matrix3d axes = upright_axes(yaw_);
  const Vector3d known = box_sigma_rad_ < kUsableDirection_rad ? size_ : Vector3d::Zero();
  Vector3d centre = motion_.position();
  Vector3d shift = Vector3d::Zero();
  for (const int axis : {1, 0, 2}) {
    const AxisView view = look_along(axis, detection);
    double least = known[axis];
    if (axis == 0 && size_.y() >= config.vehicle_width_m) {
      least = std::max(least, config.vehicle_length_m);
    }
    const double seen = view.seen.length();
    size_[axis] = view.low_end && view.high_end ? seen : std::max(seen, least);
    centre += view.seen.middle() * axes.col(axis);
    const double towards_hidden = (view.low_end ? 1.0 : 0.0) - (view.high_end ? 1.0 : 0.0);
    shift += 0.5 * towards_hidden * (size_[axis] - seen) * axes.col(axis);
  }
  const double range = (centre - detection.sensor).norm();
  const double sigma = config.face_sigma_m + config.face_sigma_growth * range;
  motion_.restart_position(centre, sigma * sigma);
  motion_.move_reference(shift);
  box_sigma_rad_ = direction_sigma();
  evaluate_width(config);
}

/// Vehicles have a greatest width, and are not wider than long.
void BoxFilter::evaluate_width(const TrackConfig& config) {
  const double too_wide = std::max({0.0, size_.y() - config.largest_width_m, size_.y() - size_.x()});
  log_likelihood_ += std::max(kWorstLog, -0.5 * std::pow(too_wide / kWidthSigma_m, 2));
}

/// Sizes and position from what is seen along the axes.
void BoxFilter::correct_box(const Detection& detection, const TrackConfig& config) {
  const double range = (motion_.position() - detection.sensor).norm();
  const double sigma = config.face_sigma_m + config.face_sigma_growth * range;
  for (int axis = 0; axis < 3; ++axis) {
    correct_axis(axis, detection, sigma);
  }
  evaluate_width(config);
}

void BoxFilter::correct_axis(int axis, const Detection& detection, double sigma) {
  const Vector3d direction = upright_axes(yaw_).col(axis);
  const AxisView view = look_along(axis, detection);
  const double here = direction.dot(motion_.position());
  const double missing = view.seen.length() - size_[axis];
  if (view.low_end && view.high_end) {
    log_likelihood_ += motion_.correct_position(direction, here + view.seen.middle(), sigma * sigma);
    log_likelihood_ += std::max(kWorstLog, -0.5 * std::pow(missing / (3.0 * sigma), 2));
    size_[axis] += kGrowth * missing;
    return;
  }
  if (!view.low_end && !view.high_end) {
    // The box holds what is seen: its centre is anywhere in an interval as long as what is not seen.
    const double hidden = std::max(0.0, -missing);
    log_likelihood_ +=
        motion_.correct_position(direction, here + view.seen.middle(), sigma * sigma + hidden * hidden / 12.0);
    size_[axis] += kGrowth * std::max(0.0, missing);
    return;
  }
  const double side = view.high_end ? 1.0 : -1.0;
  const double end = view.high_end ? view.seen.high : view.seen.low;
  log_likelihood_ += motion_.correct_position(direction, here + end - 0.5 * side * size_[axis], sigma * sigma);
  const double growth = kGrowth * std::max(0.0, missing);
  size_[axis] += growth;
  motion_.move_reference(-0.5 * side * growth * direction);
}

}  // namespace dynamic_icp::tracking
