// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <numbers>
#include <optional>
#include <utility>

#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kLogAlongSides = 8.0;       // of what has sides: it moves along them rather than anywhere
constexpr double kVehicle_m = 2.0;           // what is longer moves along its sides for sure
constexpr double kKnownDirection_rad = 0.2;  // standard deviation of the direction of a motion that shows a heading
constexpr double kSameDirection_rad = 0.2;   // headings that differ less are one
constexpr double kSideways = 0.5;            // of the velocity ahead: no body slides so much ...
constexpr double kSidewaysSigmas = 3.0;      // ... where it is known so well ...
constexpr double kSidewaysMargin_mps = 0.3;  // ... and some more ...
constexpr double kSpin_rps = 1.0;            // ... unless it spins
constexpr double kLogHopeless = -8.0;        // relative to the best hypothesis
constexpr int kManyDetections = 1 << 30;     // no drive has so many
constexpr int kDecisionDetections = 10;      // after so many the best hypothesis stays alone

/// The sides of what a body shows that moves with `velocity`, where they are long enough to have a direction.
std::optional<BodySides> sides_of(const Detection& detection, const Eigen::Vector3d& velocity) {
  const Eigen::Matrix3d& level = detection.ground.level;
  DetectionMemory memory;
  const std::pmr::vector<Eigen::Vector3d> points = points_at_mean_time(detection, velocity, memory);
  const std::optional<double> yaw = fit_yaw(points, level, 0.0, 0.5 * kQuarterTurn);
  if (!yaw) {
    return std::nullopt;
  }
  const Eigen::Matrix3d axes = level * upright_axes(*yaw);
  const double length = std::max(span_along(points, points.front(), axes.col(0), 0.0).length(),
                                 span_along(points, points.front(), axes.col(1), 0.0).length());
  return length < kShortestSide_m
             ? std::nullopt
             : std::optional(BodySides{*yaw, length, is_strip_along_sight(points, axes, detection.sensor)});
}

/// That of most others near by.
std::optional<double> likeliest_heading(const Detection& detection) {
  return detection.traffic != nullptr ? detection.traffic->likeliest_yaw(mean_of(detection.points)) : std::nullopt;
}

/// Whether directions agree, up to multiples of `period_rad`.
bool is_along(double yaw_rad, double other_rad, double period_rad) {
  return std::abs(std::remainder(yaw_rad - other_rad, period_rad)) < kSameDirection_rad;
}

}  // namespace

void Track::begin(const Detection& detection, double stamp_s, const TrackConfig& config) {
  time_s_ = stamp_s + detection.mean_time_s;
  detections_ = 1;
  has_sides_ = false;
  best_ = 0;
  hypotheses_.clear();
  hypotheses_.emplace_back(detection, std::nullopt, BoxHistory{}, config);
  add_headings(detection, BoxHistory{}, config);
  evaluate(detection, config);
}

/// The direction in which a body moves, level axes, where it is known and no person moves so fast: a vehicle of which
/// too little is seen to show its sides.
std::optional<double> Track::heading_of_motion() const {
  const Eigen::Vector3d v = body().level().transpose() * body().velocity();
  const double speed = v.head<2>().norm();
  if (is_walking_speed(speed)) {
    return std::nullopt;
  }
  const Eigen::Vector3d across = body().level() * Eigen::Vector3d(-v.y(), v.x(), 0.0) / speed;
  const Eigen::Matrix3d covariance = body().velocity_covariance_at(Eigen::Vector3d::Zero());
  if (std::sqrt(across.dot(covariance * across)) > kKnownDirection_rad * speed) {
    return std::nullopt;
  }
  return std::atan2(v.y(), v.x());
}

/// The sides of what is seen, where they are long enough to show a direction, else the motion, else others near by.
void Track::add_headings(const Detection& detection, const BoxHistory& history, const TrackConfig& config) {
  const BoxHistory along_sides{history.log_likelihood + kLogAlongSides, history.was_vehicle};
  if (const std::optional<BodySides> sides = sides_of(detection, body().velocity())) {
    has_sides_ = true;
    add_headings_along(*sides, detection, along_sides, config);
  } else if (has_heading()) {
    return;
  } else {
    const std::optional<double> heading = heading_of_motion();
    // What may be a person goes anywhere, and that it went with the others may have been refuted.
    const std::optional<double> likeliest =
        best().is_as_large_as_person() ? std::nullopt : likeliest_heading(detection);
    if (heading) {
      hypotheses_.emplace_back(detection, *heading, along_sides, config);
    }
    if (likeliest && !(heading && is_along(*likeliest, *heading, std::numbers::pi))) {
      hypotheses_.emplace_back(detection, *likeliest, heading ? along_sides : history, config);
    }
  }
}

/// Hypotheses that agree with the sides have explained these, too; and what looks like sides may be none.
void Track::add_headings_along(const BodySides& sides, const Detection& detection, const BoxHistory& along_sides,
                               const TrackConfig& config) {
  if (sides.length_m > kVehicle_m && !sides.is_strip) {
    std::erase_if(hypotheses_, [&](const BoxFilter& one) {
      return !one.has_heading() || !is_along(one.body().yaw(), sides.yaw_rad, kQuarterTurn);
    });
  }
  for (const double heading : {sides.yaw_rad, sides.yaw_rad + kQuarterTurn}) {
    const auto has_it = [&](const BoxFilter& one) {
      return one.has_heading() && is_along(one.body().yaw(), heading, std::numbers::pi);
    };
    if (std::none_of(hypotheses_.begin(), hypotheses_.end(), has_it)) {
      hypotheses_.emplace_back(detection, heading, along_sides, config);
      continue;
    }
    for (BoxFilter& one : hypotheses_) {
      one.credit(has_it(one) ? kLogAlongSides : 0.0);
    }
  }
  if (const std::optional<double> likeliest = likeliest_heading(detection);
      likeliest && !is_along(*likeliest, sides.yaw_rad, kQuarterTurn)) {
    hypotheses_.emplace_back(detection, *likeliest, along_sides, config);
  }
}

void Track::predict(double time_s, const TrackConfig& config) {
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.predict(time_s - time_s_, config);
  }
  time_s_ = time_s;
}

void Track::suppose(MotionModel model) {
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.suppose(model);
  }
}

void Track::point_along(double yaw_rad) {
  const auto points_elsewhere = [&](const BoxFilter& one) {
    return !one.has_heading() || !is_along(one.body().yaw(), yaw_rad, 2.0 * std::numbers::pi);
  };
  if (!std::ranges::all_of(hypotheses_, points_elsewhere)) {
    std::erase_if(hypotheses_, points_elsewhere);
    choose_best();
  }
}

void Track::end_at(const Eigen::Vector3d& along, double place_m) {
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.end_at(along, place_m);
  }
}

void Track::set_room(const Room& room) { hypotheses_[best_].set_room(is_sure_of_heading() ? room : Room{}); }

void Track::include(const OrientedBox& part, bool is_splinter) {
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.include(part, is_splinter);
  }
}

void Track::correct(const Detection& detection, double stamp_s, const TrackConfig& config) {
  predict(stamp_s + detection.mean_time_s, config);
  for (BoxFilter& hypothesis : hypotheses_) {
    hypothesis.correct(detection, config);
  }
  ++detections_;
  if (moves_sideways()) {
    return begin(detection, stamp_s, config);
  }
  if (!has_sides_ || !has_heading()) {  // sides tell more of a heading than the motion of what little was seen at first
    // A new hypothesis pays for knowing nothing before; one like the old, begun now, shows how much.
    const BoxFilter anew(detection, std::nullopt, BoxHistory{}, config);
    add_headings(detection, {best().log_likelihood() - anew.log_likelihood(), best().was_vehicle()}, config);
  }
  evaluate(detection, config);
}

/// Whether the body moves where it does not point, beyond doubt: then its heading, which has been decided on, is wrong.
bool Track::moves_sideways() const {
  if (detections_ <= kDecisionDetections || !best().has_heading() || std::abs(body().yaw_rate()) > kSpin_rps) {
    return false;
  }
  const BoxEstimate now = best().estimate();
  const Eigen::Vector3d along = now.box.axes.col(0);
  const Eigen::Vector3d across = now.box.axes.col(1);
  const double slip = std::abs(across.dot(now.velocity));
  const double sigma = std::sqrt(across.dot(now.velocity_covariance * across));
  return slip > kSideways * std::abs(along.dot(now.velocity)) && slip > kSidewaysSigmas * sigma + kSidewaysMargin_mps;
}

bool Track::has_heading() const {
  return std::any_of(hypotheses_.begin(), hypotheses_.end(), [](const BoxFilter& one) { return one.has_heading(); });
}

double Track::probability() const {
  double weights = 0.0;
  for (const BoxFilter& hypothesis : hypotheses_) {
    weights += std::exp(hypothesis.log_posterior() - best().log_posterior());
  }
  return 1.0 / weights;
}

/// What the traffic around, as it is known now, says of the hypotheses.
void Track::ask_traffic(const Detection& detection, const TrackConfig& config) {
  if (detection.traffic == nullptr) {
    return;
  }
  const Eigen::Vector3d position = mean_of(detection.points);
  for (BoxFilter& one : hypotheses_) {
    if (one.has_heading()) {  // else it may be anything
      one.set_log_prior(
          detection.traffic->log_ratio_of_heading(position, one.body().yaw()) +
          detection.traffic->log_ratio_of_speed(position, one.body().velocity().norm(), config.prior_speed_mps));
    }
  }
}

void Track::evaluate(const Detection& detection, const TrackConfig& config) {
  if (hypotheses_.size() == 1) {
    best_ = 0;
    return;
  }
  ask_traffic(detection, config);
  choose_best();
  const BoxFilter best = hypotheses_[best_];
  if (detections_ >= kDecisionDetections) {
    hypotheses_ = {best};
  }
  std::erase_if(hypotheses_, [&](const BoxFilter& hypothesis) {
    return hypothesis.log_posterior() - best.log_posterior() < kLogHopeless;
  });
  choose_best();
}

void Track::choose_best() {
  const auto likeliest = std::ranges::max_element(hypotheses_, {}, &BoxFilter::log_posterior);
  best_ = static_cast<std::size_t>(likeliest - hypotheses_.begin());
}

BoxEstimate Track::estimate(const VehicleSizes& sizes) const {
  BoxEstimate result = best().estimate(sizes);
  Eigen::Matrix3d velocity = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d centre = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (const BoxFilter& hypothesis : hypotheses_) {
    const double weight = std::exp(hypothesis.log_posterior() - best().log_posterior());
    const BoxEstimate other = hypothesis.estimate(sizes);
    const Eigen::Vector3d dv = other.velocity - result.velocity;
    const Eigen::Vector3d dc = other.box.centre - result.box.centre;
    velocity += weight * (other.velocity_covariance + dv * dv.transpose());
    centre += weight * (other.centre_covariance + dc * dc.transpose());
    weights += weight;
  }
  result.velocity_covariance = velocity / weights;
  result.centre_covariance = centre / weights;
  return result;
}

void Track::state(StateArchive& archive) {
  archive.each(hypotheses_, BoxFilter::blank(), [&](BoxFilter& one) { archive(one); });
  archive(best_, time_s_, detections_, has_sides_);
  archive.require(best_ < hypotheses_.size() && hypotheses_.size() <= kMaxHypotheses && detections_ >= 0 &&
                      detections_ < kManyDetections && std::abs(time_s_) < 1e9,
                  "a track");
}

}  // namespace dynamic_icp::tracking
