// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track_merging.hpp"

#include <algorithm>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kSeeThrough_m = 1.0;      // beyond a gap
constexpr double kSplinter = 0.1;          // a track with this share of the points of another may be a part of it
constexpr double kPartVelocity_mps = 0.5;  // standard deviation between the velocities of parts of a body
constexpr double kPartSigmas = 3.0;

/// Whether two bodies may have one velocity.
bool may_be_equal(const BoxEstimate& a, const BoxEstimate& b) {
  const Eigen::Vector3d apart = a.velocity - b.velocity;
  const Eigen::Matrix3d covariance = a.velocity_covariance + b.velocity_covariance +
                                     kPartVelocity_mps * kPartVelocity_mps * Eigen::Matrix3d::Identity();
  return apart.dot(covariance.inverse() * apart) < kPartSigmas * kPartSigmas;
}

}  // namespace

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
  const bool is_splinter = static_cast<double>(small.points) < kSplinter * static_cast<double>(large.points);
  if (is_splinter && std::min(distance_outside(of_large, of_small.centre),
                              distance_outside(large.now.box, of_small.centre)) <= config.growth_m) {
    return true;
  }
  if (!large.predicted.best().has_heading() || size_with(of_large, of_small).y() > config.track.largest_width_m) {
    return false;
  }
  // Sides of one body, seen apart; what is seen through a gap parts two.
  const Gap gap = gap_between(of_large, of_small);
  const double link_m = config.grouping.link_distance_m +
                        config.grouping.link_growth * (gap.middle - T_world_sensor.translation()).norm();
  return (distance_outside(large.now.box, of_small.centre) <= 0.0 || gap.width <= link_m) &&
         view.hides(T_world_sensor.inverse() * gap.middle, -kSeeThrough_m);
}

}  // namespace dynamic_icp::tracking
