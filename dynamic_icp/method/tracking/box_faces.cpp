// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "dynamic_icp/method/tracking/box_filter.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

// Where the faces of a body are.
namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kLoose_m =
    1.5;  // standard deviation of the middle of what is seen of a body, if as much: others slide before it
constexpr double kFrame_m = 3.6;         // of a tractor, below the trailer ...
constexpr double kLongestCab_m = 4.0;    // ... behind its cab
constexpr double kJoint_m = 0.4;         // standard deviation of where parts of a body meet
constexpr double kCorner_m = 0.5;        // radius between the sides of vehicles and their fronts and rears
constexpr double kInside_m = 1.0;        // an end so far within what was seen before is none
constexpr double kFalseEnd_m = 0.1;      // what is seen so far beyond a face ...
constexpr double kFalseEndSigmas = 3.0;  // ... and its noise shows that the body did not end there
constexpr double kGrowth = 0.3;          // of a bound, towards what is seen beyond it: noise must not move it
constexpr double kStump = 0.25;          // of the typical length or width ...
constexpr double kLorryStump = 0.75;     // ... but the widths of what is long and high differ little
constexpr double kVehicleWidth_m = 1.4;  // what is less wide may be short
constexpr double kFacing = 0.3;          // cosine of the line of sight to a face that looks at the sensor
constexpr double kGroundSigma_m = 0.05;

}  // namespace

double face_sigma(const Vector3d& where, const Detection& detection, const TrackConfig& config) {
  return config.face_sigma_m + config.face_sigma_growth * (where - detection.sensor).norm();
}

void BoxFilter::correct_faces(std::span<const Vector3d> points, const Detection& detection, const TrackConfig& config) {
  const std::optional<double> top_m = is_known(Face::kTop) ? std::optional(reach(Face::kTop)) : std::nullopt;
  const std::array<AxisView, 3> views =
      views_along(body_.axes(), body_.position(), points, body_.doppler_velocity(detection.sensor), detection, top_m);
  const Vector3d reference = body_.position();
  const auto seen_along = [&](int axis) {  // from where the reference is now: corrections move it
    const double moved = body_.axes().col(axis).dot(body_.position() - reference);
    const Interval& seen = views[static_cast<std::size_t>(axis)].seen;
    return Interval{seen.low - moved, seen.high - moved};
  };
  for (const int axis : {2, 1, 0}) {  // what is wide and high is a vehicle
    const AxisView& view = views[static_cast<std::size_t>(axis)];
    if (axis < 2) {
      correct_middle(axis, seen_along(axis));
    }
    correct_face(high_face(axis), view.high, detection, config);
    correct_face(low_face(axis), view.low, detection, config);
  }
  for (const int axis : {0, 1}) {
    last_seen_[static_cast<std::size_t>(axis)] = seen_along(axis);
  }
  size_log_likelihood_ = size_log_likelihood(config);  // before what is too wide is cut off
  limit_width(config);
  limit_length(face_sigma(body_.position(), detection, config));
  forget_stumps(detection);
  if (detection.ground.offset_m) {
    const Vector3d up = detection.ground.up();
    const Vector3d on_ground = body_.position() + (*detection.ground.offset_m - up.dot(body_.position())) * up;
    const double sigma = kGroundSigma_m + face_sigma(on_ground, detection, config);
    faces_[index_of(Face::kBottom)] = FaceView::kSeen;
    body_.correct_face(Face::kBottom, on_ground, sigma * sigma);
  }
}

void BoxFilter::correct_face(Face face, const EndView& end, const Detection& detection, const TrackConfig& config) {
  const std::size_t i = index_of(face);
  const bool was_seen = faces_[i] != FaceView::kUnknown;
  if (is_known(face) && end.is_of_few) {  // which may be somebody else's
    faces_[i] = was_seen ? FaceView::kHidden : FaceView::kUnknown;
    return;
  }
  const Vector3d outward = side_of(face) * body_.axes().col(axis_of(face));
  // Where rays pass beside an end they miss it by less than their distance there; faces that look at them they meet.
  const bool is_beside = outward.dot((end.middle - detection.sensor).normalized()) > -kFacing;
  const double gap = is_beside ? end.gap : 0.0;
  const Vector3d at_end = end.middle + (end.inside + 0.5 * gap) * outward;
  const double seen = outward.dot(at_end - body_.position());
  const Vector3d face_end = at_end + hidden_corner(face, at_end, detection) * outward;
  const double sigma = std::hypot(face_sigma(at_end, detection, config), kUniform * gap);
  const double known_sigma = std::hypot(sigma, body_.beyond_sigma(face, at_end));
  // Where it was seen to reach farther it does not end.
  const bool is_possible = is_known(face) || seen > least_[i] - kInside_m;
  // Hoods and cabins are lower than what was seen before.
  const double lower = is_known(face) ? -body_.beyond(face, at_end) : least_[i] - seen;
  const bool is_lower =
      face == Face::kTop && lower > kFalseEnd_m + kFalseEndSigmas * (is_known(face) ? known_sigma : sigma);
  if (face == Face::kTop && !is_lower) {
    top_is_cut_ = end.is_cut;
  }
  const bool is_end = end.is_true && is_possible && !is_lower;
  // Where its upper part ends it may not, but that shows the motion, too, until the end is seen.
  const bool is_upper_end = end.hidden > 0.0 && is_possible && !was_seen;
  if (!was_seen && !is_known(face)) {
    least_[i] = std::max(least_[i], seen);
  } else {
    least_[i] += kGrowth * std::max(0.0, seen - least_[i]);
  }
  if (is_known(face) && !was_seen && is_end) {
    body_.forget_face(face, kUnknownFace_m * kUnknownFace_m);  // only its upper part ended there
  } else if (is_known(face) && body_.beyond(face, at_end) > kFalseEnd_m + kFalseEndSigmas * known_sigma) {
    body_.forget_face(face, kUnknownFace_m * kUnknownFace_m);  // it was no end
    log_likelihood_ -= was_seen ? 0.5 * kFalseEndSigmas * kFalseEndSigmas : 0.0;
    least_[i] = seen;
  }
  const bool was_known = is_known(face);  // else it could be anywhere, and no place surprises
  if (is_end) {
    faces_[i] = FaceView::kSeen;
    hidden_[i] = is_part_ ? hidden_[i] : 0.0;
  } else if (is_upper_end) {
    hidden_[i] = end.hidden;
  } else {
    faces_[i] = was_seen ? FaceView::kHidden : FaceView::kUnknown;
    if (!was_known || body_.beyond(face, at_end) < known_sigma) {
      return;
    }
  }
  const double log_likelihood = body_.correct_face(face, is_end ? face_end : at_end, sigma * sigma);
  log_likelihood_ += was_known ? log_likelihood : 0.0;
}

/// How far a face is beyond the last point of a side that can be seen, m: round corners hide behind themselves.
double BoxFilter::hidden_corner(Face face, const Vector3d& at_end, const Detection& detection) const {
  if (axis_of(face) != 0 || !has_heading_ || may_be_person() || likely_width() < kVehicleWidth_m) {
    return 0.0;
  }
  const Vector3d outward = side_of(face) * body_.axes().col(0);
  const Vector3d sight = (at_end - detection.sensor).normalized();
  const double away = std::max(0.0, outward.dot(sight));
  return kCorner_m * (1.0 - std::sqrt(std::max(0.0, 1.0 - away * away)));
}

/// No body is wider than the widest: sides that say so and are not seen now are forgotten, and bounds are drawn in.
void BoxFilter::limit_width(const TrackConfig& config) {
  const double excess = reach(Face::kLeft) + reach(Face::kRight) - config.largest_width_m;
  if (!has_heading_ || excess <= 0.0) {
    return;
  }
  const auto is_fixed = [&](Face face) { return is_known(face) && faces_[index_of(face)] == FaceView::kSeen; };
  const double share = is_fixed(Face::kLeft) == is_fixed(Face::kRight) ? 0.5 : 1.0;
  for (const Face face : {Face::kLeft, Face::kRight}) {
    if (share == 1.0 && is_fixed(face)) {
      continue;
    }
    least_[index_of(face)] = reach(face) - share * excess;
    faces_[index_of(face)] = FaceView::kUnknown;
    body_.forget_face(face, kUnknownFace_m * kUnknownFace_m);
  }
}

/// No body is longer than the longest: where the parts of one add up to more, and neither end was seen, it has not gone
/// as far as its velocity said.
void BoxFilter::limit_length(double sigma_m) {
  if (!has_heading_ || is_known(Face::kFront) || is_known(Face::kRear)) {
    return;
  }
  const double longest = longest_length(likely_width(), span(2));
  const double excess = span(0) - longest;
  if (excess <= 0.0) {
    return;
  }
  Interval& seen = *last_seen_[0];
  const bool is_at_front = reach(Face::kFront) - seen.high < seen.low + reach(Face::kRear);
  const Vector3d along = body_.axes().col(0);
  const Vector3d before = body_.position();
  log_likelihood_ += body_.correct_position(0, before + (is_at_front ? excess : -excess) * along, sigma_m * sigma_m);
  const double moved = along.dot(body_.position() - before);
  seen = {seen.low - moved, seen.high - moved};
  least_[index_of(Face::kFront)] = is_at_front ? seen.high : std::max(seen.high, longest + seen.low);
  least_[index_of(Face::kRear)] = is_at_front ? std::max(-seen.low, longest - seen.high) : -seen.low;
}

/// What is a small part of the body that its other sides speak of did not end where it seemed to, away from the sensor.
void BoxFilter::forget_stumps(const Detection& detection) {
  if (!has_heading_ || is_as_large_as_person()) {
    return;
  }
  const double height = span(2);
  const auto forget = [&](int axis) {
    for (const Face face : {high_face(axis), low_face(axis)}) {
      const Vector3d outward = side_of(face) * body_.axes().col(axis);
      if (outward.dot(body_.position() + body_.distance(face) * outward - detection.sensor) > 0.0) {
        least_[index_of(face)] = body_.distance(face);
        faces_[index_of(face)] = FaceView::kUnknown;
        body_.forget_face(face, kUnknownFace_m * kUnknownFace_m);
      }
    }
  };
  const double narrow = is_lorry_sized(span(0), height) ? kLorryStump : kStump;
  if (is_whole(1) && span(1) < narrow * typical_width_by_height(height).mean) {
    forget(1);
  }
  const double width = likely_width();
  if (!is_part_ && is_whole(0) && width > kVehicleWidth_m && span(0) < kStump * typical_length(width, height).mean) {
    forget(0);
  }
}

/// Where neither end was ever seen, the middle of the points holds the body, as far as it shows as much as before.
void BoxFilter::correct_middle(int axis, const Interval& seen) {
  const std::optional<Interval>& last = last_seen_[static_cast<std::size_t>(axis)];
  if (!last || is_known(high_face(axis)) || is_known(low_face(axis))) {
    return;
  }
  const double sigma = kLoose_m + std::abs(last->length() - seen.length());
  const Vector3d reference = body_.position() + (seen.middle() - last->middle()) * body_.axes().col(axis);
  log_likelihood_ += body_.correct_position(axis, reference, sigma * sigma);
}

void BoxFilter::include(const OrientedBox& part, bool is_splinter) {
  for (const Face face : {Face::kFront, Face::kRear}) {
    const Vector3d outward = side_of(face) * body_.axes().col(0);
    const double half = 0.5 * (part.axes.transpose() * outward).cwiseAbs().dot(part.size);
    const double end = outward.dot(part.centre - body_.position()) + half;
    double& least = least_[index_of(face)];
    if (!has_heading_) {
      continue;
    }
    if (!is_known(face)) {
      least = std::max(least, end);
    } else if (!is_splinter &&
               end - body_.distance(face) > kInside_m + kFalseEndSigmas * std::sqrt(body_.variance(face))) {
      body_.forget_face(face, kUnknownFace_m * kUnknownFace_m);  // it was no end
      faces_[index_of(face)] = FaceView::kUnknown;
      least = end;
    }
  }
}

void BoxFilter::set_room(const Room& room) {
  free_ = {reach(Face::kFront) + room.ahead, reach(Face::kRear) + room.behind};
}

void BoxFilter::end_at(const Vector3d& along, double place_m) {
  const double cosine = along.dot(body_.axes().col(0));
  if (has_heading_ && std::abs(cosine) > std::numbers::sqrt2 / 2.0) {
    const Vector3d end = body_.position() + (place_m - along.dot(body_.position())) * along;
    const Face face = cosine > 0.0 ? Face::kFront : Face::kRear;
    body_.correct_face(face, end, kJoint_m * kJoint_m);
    faces_[index_of(face)] = FaceView::kHidden;
    hidden_[index_of(face)] = face == Face::kRear && span(0) < kLongestCab_m ? kFrame_m : 0.0;
    is_part_ = true;
  }
}

}  // namespace dynamic_icp::tracking
