// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track_merging.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kSeeThrough_m = 1.0;      // beyond a gap
constexpr double kSplinter = 0.1;          // a track with this share of the points of another may be a part of it
constexpr double kBefore_m = 1.0;          // beyond a face that is seen
constexpr double kOtherTop_m = 1.0;        // between the highest parts of a body
constexpr double kPartVelocity_mps = 0.5;  // standard deviation between the velocities of parts of a body
constexpr double kPartSigmas = 3.0;
constexpr double kKnownYaw_rad = 0.05;  // what is known worse says nothing of what lies behind

/// Whether the tops of both were seen, at heights that no body has.
bool have_other_tops(const BoxEstimate& a, const BoxEstimate& b) {
  const auto is_seen = [](const BoxEstimate& one) { return one.faces[index_of(Face::kTop)] != FaceView::kUnknown; };
  const Eigen::Vector3d up = a.box.axes.col(2);
  const double apart = up.dot(a.box.centre - b.box.centre) + 0.5 * (a.box.size.z() - b.box.size.z());
  return is_seen(a) && is_seen(b) && std::abs(apart) > kOtherTop_m;
}

/// Whether two bodies may have one velocity.
bool may_be_equal(const BoxEstimate& a, const BoxEstimate& b) {
  const Eigen::Vector3d apart = a.velocity - b.velocity;
  const Eigen::Matrix3d covariance = a.velocity_covariance + b.velocity_covariance +
                                     kPartVelocity_mps * kPartVelocity_mps * Eigen::Matrix3d::Identity();
  return apart.dot(covariance.inverse() * apart) < kPartSigmas * kPartSigmas;
}

/// Whether the other one reaches far beyond a face of a body that looks at the sensor and is seen: none of it lies
/// there.
bool reaches_before(const OrientedBox& other, const BoxEstimate& body, const Eigen::Vector3d& sensor) {
  return std::ranges::any_of(kFaces, [&](Face face) {
    const int axis = axis_of(face);
    const Eigen::Vector3d outward = side_of(face) * body.box.axes.col(axis);
    const Eigen::Vector3d at = body.box.centre + 0.5 * body.box.size[axis] * outward;
    if (axis == 2 || body.faces[index_of(face)] != FaceView::kSeen || outward.dot(sensor - at) < 0.0) {
      return false;
    }
    const double reach = 0.5 * (other.axes.transpose() * outward).cwiseAbs().dot(other.size);
    return outward.dot(other.centre - at) + reach > kBefore_m;
  });
}

/// How wide both are together, m: as the boxes say, or, if that is less, what was seen at last.
double width_together(const SeenTrack& a, const SeenTrack& b, const OrientedBox& of_a, const OrientedBox& of_b) {
  const double of_boxes = size_with(of_a, of_b).y();
  if (a.where.empty() || b.where.empty()) {
    return of_boxes;
  }
  const auto across = [&](std::span<const Eigen::Vector3d> points) {
    return span_along(points, of_a.centre, of_a.axes.col(1), kViewTrim);
  };
  const Interval first = across(a.where);
  const Interval second = across(b.where);
  return std::min(of_boxes, std::max(first.high, second.high) - std::min(first.low, second.low));
}

}  // namespace

bool is_splinter(std::size_t points, std::size_t of_points) {
  return static_cast<double>(points) < kSplinter * static_cast<double>(of_points);
}

bool are_same_object(const SeenTrack& a, const SeenTrack& b, const RangeImage& view,
                     const Eigen::Isometry3d& T_world_sensor, const TrackerConfig& config) {
  const bool a_is_smaller = a.points < b.points;
  const SeenTrack& small = a_is_smaller ? a : b;
  const SeenTrack& large = a_is_smaller ? b : a;
  const OrientedBox of_small = small.predicted.best().seen_box();
  const OrientedBox of_large = large.predicted.best().seen_box();
  if (distance_outside(of_large, of_small.centre) <= 0.0 || distance_outside(of_small, of_large.centre) <= 0.0) {
    return true;
  }
  // What coasts has no points: it is hidden, not a part.
  if (small.points == 0 || !may_be_equal(small.now, large.now)) {
    return false;
  }
  const bool may_be_splinter = is_splinter(small.points, large.points);
  if (may_be_splinter && std::min(distance_outside(of_large, of_small.centre),
                                  distance_outside(large.now.box, of_small.centre)) <= config.growth_m) {
    return true;
  }
  const Eigen::Vector3d together = size_with(of_large, of_small);
  const double likely_width = std::max(together.y(), typical_width_by_height(together.z()).mean);
  if (have_other_tops(small.now, large.now) || together.x() > longest_length(likely_width, together.z())) {
    return false;
  }
  const Eigen::Vector3d sensor = T_world_sensor.translation();
  if (reaches_before(of_small, large.now, sensor) && reaches_before(of_large, small.now, sensor)) {
    return false;
  }
  const Gap gap = gap_between(of_large, of_small);
  const double range_m = (gap.middle - sensor).norm();
  const double behind_m = std::abs(of_large.axes.col(0).dot(of_large.centre - of_small.centre));
  const double yaw_sigma_rad = large.predicted.best().body().yaw_sigma();
  const double width_sigma_m = config.track.face_sigma_m + config.track.face_sigma_growth * range_m +
                               (yaw_sigma_rad < kKnownYaw_rad ? yaw_sigma_rad * behind_m : 0.0);
  if (!large.predicted.best().has_heading() ||
      width_together(large, small, of_large, of_small) > config.track.largest_width_m + width_sigma_m) {
    return false;
  }
  // No two bodies are in one place.
  if (distance_outside(large.now.box, small.now.box.centre) <= 0.0 &&
      distance_outside(small.now.box, large.now.box.centre) <= 0.0) {
    return true;
  }
  // Sides of one body, seen apart; what is seen through a gap parts two.
  const double usual_m = config.grouping.link_distance_m + config.grouping.link_growth * range_m;
  const double link_m = may_be_splinter ? std::max(usual_m, config.growth_m) : usual_m;
  return (distance_outside(large.now.box, of_small.centre) <= 0.0 || gap.width <= link_m) &&
         view.hides(T_world_sensor.inverse() * gap.middle, -kSeeThrough_m);
}

}  // namespace dynamic_icp::tracking
