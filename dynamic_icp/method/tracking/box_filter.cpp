// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kReference_m = 0.01;     // the reference is a point of the body by definition
constexpr double kKnownFace_m = 0.5;      // a face known better than this was seen
constexpr double kYawSearch_rad = 0.35;   // about the heading
constexpr double kOnePointYaw_rad = 0.8;  // standard deviation of directions fitted to n points, times the root of n
constexpr double kNarrow_m = 1.2;         // strips are not so wide ...
constexpr double kAlongSight = 0.998;     // ... and so much along the line of sight (cosine)
constexpr double kFirstYawSigma_rad = 0.1;
constexpr double kSideslip_rad = 0.03;   // between heading and motion of the middle of a body ...
constexpr double kSideslip_mps = 0.1;    // ... and whatever the speed ...
constexpr double kPivotShare = 0.15;     // ... and of the length that the point without sideslip is behind the middle
constexpr double kTightestTurn_m = 5.0;  // radius in which a vehicle turns, about ...
constexpr double kTurning_rps = 0.1;     // ... and whatever the speed
constexpr double kBackwards_mps = 0.5;   // what moves backwards faster than this was taken the wrong way round
constexpr double kLogHeading = -2.0;     // a scan without heading: more than the corrections of one cost
constexpr double kWidthSigma_m = 0.5;
constexpr double kSureSigmas = 3.0;    // nothing is beyond doubt that is less likely
constexpr double kSizeScatter = 0.25;  // of what is seen of sizes about the typical ones, as a share
constexpr double kWorstLog = -5.0;
constexpr double kErrorAngle_rad = 0.1;  // within it points share errors of the Doppler, and across it these differ

BodyFilter prior(const Vector3d& position, std::optional<double> yaw_rad, double yaw_sigma_rad, const Matrix3d& level,
                 const TrackConfig& config) {
  BodyFilter::Vector state = BodyFilter::Vector::Zero();
  state.head<3>() = position;
  state[BodyFilter::kYaw] = yaw_rad.value_or(0.0);
  BodyFilter::Vector variances = BodyFilter::Vector::Zero();
  variances.head<3>().setConstant(kReference_m * kReference_m);
  variances[BodyFilter::kYaw] = yaw_sigma_rad * yaw_sigma_rad;
  variances[BodyFilter::kYawRate] = yaw_sigma_rad > 0.0 ? config.prior_yaw_rate_rps * config.prior_yaw_rate_rps : 0.0;
  variances[BodyFilter::kAcceleration] =
      yaw_sigma_rad > 0.0 ? config.motion.acceleration_mps2 * config.motion.acceleration_mps2 : 0.0;
  variances.tail<kFaces.size()>().setConstant(kUnknownFace_m * kUnknownFace_m);
  BodyFilter::Matrix covariance = variances.asDiagonal();
  const Vector3d speeds(config.prior_speed_mps, config.prior_speed_mps, config.motion.vertical_mps);
  covariance.block<3, 3>(BodyFilter::kVelocity, BodyFilter::kVelocity) =
      level * speeds.cwiseAbs2().asDiagonal() * level.transpose();
  return {state, covariance, level};
}

/// The heading of the line of sight, level axes.
double sight_yaw(const Vector3d& point, const Detection& detection) {
  const Vector3d sight = detection.ground.level.transpose() * (point - detection.sensor);
  return std::atan2(sight.y(), sight.x());
}

}  // namespace

bool is_strip_along_sight(std::span<const Vector3d> points, const Matrix3d& axes, const Vector3d& sensor) {
  const Vector3d sight = axes.transpose() * (points.front() - sensor);
  const double least = kAlongSight * sight.head<2>().norm();
  const bool is_along_first = std::abs(sight.x()) > least;
  if (!is_along_first && !(std::abs(sight.y()) > least)) {
    return false;  // as most: before the spans, which take time
  }
  const double length = span_along(points, sensor, axes.col(0), kViewTrim).length();
  const double width = span_along(points, sensor, axes.col(1), kViewTrim).length();
  return std::min(length, width) < kNarrow_m && (length < width) != is_along_first;
}

BoxFilter::BoxFilter(const Detection& detection, std::optional<double> yaw_rad, const BoxHistory& history,
                     const TrackConfig& config)
    : body_(prior(mean_of(detection.points), yaw_rad, yaw_rad ? kFirstYawSigma_rad : 0.0, detection.ground.level,
                  config)),
      has_heading_(yaw_rad.has_value()),
      was_vehicle_(history.was_vehicle),
      log_likelihood_(history.log_likelihood) {
  if (!has_heading_) {
    body_ = prior(body_.position(), sight_yaw(body_.position(), detection), 0.0, detection.ground.level, config);
  }
  correct(detection, config);
}

void BoxFilter::predict(double dt_s, const TrackConfig& config) {
  body_.predict(dt_s, config.motion);
  models_.predict(dt_s);
}

void BoxFilter::correct(const Detection& detection, const TrackConfig& config) {
  body_.set_level(detection.ground.level);
  const BodyFilter before = body_;
  correct_doppler(detection, config);
  if (has_heading_) {
    DetectionMemory memory;
    correct_heading(points_at_mean_time(detection, body_.velocity(), memory), detection, config);
  }
  DetectionMemory memory;
  correct_faces(points_at_mean_time(detection, body_.velocity(), memory), detection, config);
  was_vehicle_ = was_vehicle_ || is_fast_for_sure();
  if (!has_heading_ && !is_as_large_as_person()) {  // persons need none
    log_likelihood_ += kLogHeading;
  }
  models_.correct(before, body_);
}

/// Whether no person moves as fast, beyond doubt.
bool BoxFilter::is_fast_for_sure() const {
  const double speed = body_.velocity().norm();
  const Vector3d ahead = body_.velocity().normalized();
  const double sigma = std::sqrt(ahead.dot(body_.velocity_covariance_at(Vector3d::Zero()) * ahead));
  return !is_walking_speed(speed - kSureSigmas * sigma);
}

/// Of what is hidden on all sides there may be any amount more.
bool BoxFilter::is_as_large_as_person() const {
  return !was_vehicle_ && (is_whole(0) || is_whole(1)) && is_person_sized(std::max(span(0), span(1)), span(2));
}

bool BoxFilter::may_be_person() const { return is_as_large_as_person() && is_walking_speed(body_.velocity().norm()); }

void BoxFilter::correct_doppler(const Detection& detection, const TrackConfig& config) {
  const ClusterVelocity measured = motion_of(detection, body_.yaw_rate(), config.doppler_sigma_mps);
  spread_mps_ = measured.spread_mps;
  signal_mps_ = measured.signal_mps;
  // Roll and pitch of the body look like a vertical velocity, the more the farther it is.
  const Vector3d up = detection.ground.up();
  const double sway = config.sway_rps * (body_.position() - detection.sensor).norm();
  // An error that changes over the body looks like a velocity across the line of sight.
  const Vector3d sight = (body_.position() - detection.sensor).normalized();
  const double shared = config.doppler_floor_mps;
  const double changing = config.doppler_floor_mps / kErrorAngle_rad;
  const Matrix3d along_sight = sight * sight.transpose();
  const Matrix3d floor = shared * shared * along_sight + changing * changing * (Matrix3d::Identity() - along_sight) +
                         sway * sway * up * up.transpose();
  log_likelihood_ += body_.correct_doppler(measured, detection.sensor, floor, shared);
}

/// Vehicles point where their sides do, and move there.
void BoxFilter::correct_heading(std::span<const Vector3d> points, const Detection& detection,
                                const TrackConfig& config) {
  if (const std::optional<double> fitted = fit_yaw(points, body_.level(), body_.yaw(), kYawSearch_rad)) {
    const Matrix3d axes = body_.level() * upright_axes(*fitted);
    const double side = std::max(span_along(points, body_.position(), axes.col(0), kViewTrim).length(),
                                 span_along(points, body_.position(), axes.col(1), kViewTrim).length());
    if (side >= kShortestSide_m && !is_strip_along_sight(points, axes, detection.sensor)) {
      const double sigma = std::hypot(config.yaw_sigma_rad, face_sigma(body_.position(), detection, config) / side,
                                      kOnePointYaw_rad / std::sqrt(static_cast<double>(points.size())));
      log_likelihood_ += body_.correct_yaw(*fitted, sigma * sigma);
    }
  }
  const double length = reach(Face::kFront) + reach(Face::kRear);
  const double sigma_mps = kSideslip_mps + kSideslip_rad * body_.velocity().norm() +
                           kPivotShare * std::max(0.0, length) * std::abs(body_.yaw_rate());
  log_likelihood_ += body_.correct_sideslip(sigma_mps * sigma_mps);
  const double turn_rps = kTurning_rps + body_.velocity().norm() / kTightestTurn_m;
  body_.correct_yaw_rate(0.0, turn_rps * turn_rps);
  if (body_.axes().col(0).dot(body_.velocity()) < -kBackwards_mps) {
    body_.turn_around();
    std::swap(free_[0], free_[1]);
    for (const int axis : {0, 1}) {
      std::swap(least_[index_of(high_face(axis))], least_[index_of(low_face(axis))]);
      std::swap(faces_[index_of(high_face(axis))], faces_[index_of(low_face(axis))]);
      std::swap(hidden_[index_of(high_face(axis))], hidden_[index_of(low_face(axis))]);
      if (std::optional<Interval>& last = last_seen_[static_cast<std::size_t>(axis)]) {
        last = Interval{-last->high, -last->low};
      }
    }
  }
}

/// How likely the sizes are that were seen: what is known of them, and what is too long or wide already. Not of a body
/// without heading, which has neither.
double BoxFilter::size_log_likelihood(const TrackConfig& config) const {
  const double height = span(2);
  if (!has_heading_ || may_be_person()) {
    return 0.0;
  }
  const auto surprise = [&](int axis, const Belief& typical) {
    const double off = span(axis) - typical.mean;
    return is_whole(axis) || off > 0.0 ? off / (kSizeScatter * typical.mean) : 0.0;
  };
  const Belief width = typical_width_by_height(height);
  const double of_width = surprise(1, width);
  const double of_length = surprise(0, typical_length(likely_width(), height));
  const double too_wide = std::max(0.0, span(1) - config.largest_width_m) / kWidthSigma_m;
  return std::max(kWorstLog, -0.5 * (of_width * of_width + of_length * of_length + too_wide * too_wide));
}

bool BoxFilter::is_known(Face face) const { return body_.variance(face) < kKnownFace_m * kKnownFace_m; }

double BoxFilter::reach(Face face) const { return is_known(face) ? body_.distance(face) : least_[index_of(face)]; }

BoxFilter BoxFilter::blank() {
  return BoxFilter(BodyFilter(BodyFilter::Vector::Zero(), BodyFilter::Matrix::Zero(), Eigen::Matrix3d::Identity()));
}

void BoxFilter::state(StateArchive& archive) {
  archive(body_, models_, has_heading_, was_vehicle_, is_part_, top_is_cut_, least_, faces_, hidden_, free_,
          log_likelihood_, size_log_likelihood_, log_prior_, spread_mps_, signal_mps_);
  for (std::optional<Interval>& seen : last_seen_) {
    bool is_known = seen.has_value();
    archive(is_known);
    Interval interval = seen.value_or(Interval{});
    archive(interval.low, interval.high);
    seen = is_known ? std::optional(interval) : std::nullopt;
  }
}

}  // namespace dynamic_icp::tracking
