// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/tracking/body_filter.hpp"
#include "dynamic_icp/method/tracking/grouping_config.hpp"

namespace dynamic_icp::tracking {

/// How well one scan measures an object, and what is taken for likely of objects never seen before.
struct TrackConfig {
  MotionNoise motion;
  double doppler_sigma_mps = 0.05;   ///< of one point
  double doppler_floor_mps = 0.04;   ///< of errors that points of an object share, and of the mean of those of beams
  double sway_rps = 0.02;            ///< roll and pitch rate of objects, which the state does not hold
  double face_sigma_m = 0.04;        ///< of a side of the box, at the sensor
  double face_sigma_growth = 0.002;  ///< m per metre of range
  double yaw_sigma_rad = 0.05;       ///< between the sides of a body and its motion
  double prior_speed_mps = 20.0;     ///< standard deviation of either horizontal part of a velocity
  double prior_yaw_rate_rps = 0.35;  ///< standard deviation
  double largest_width_m = 2.6;      ///< no vehicle is wider
};

ConfigFields fields(TrackConfig& config);

struct TrackerConfig {
  GroupingConfig grouping;
  TrackConfig track;
  double min_range_m = 1.0;           ///< what is nearer to its sensor belongs to the vehicle, or is the window
  int min_points = 10;                ///< a group of fewer points is no object
  int confirm_points = 40;            ///< so many points at once confirm an object in its first scan
  int confirm_scans = 2;              ///< else it takes so many scans with points
  double confirm_sigma_mps = 3.0;     ///< and its velocity must be known so well ...
  int confirm_anyway_scans = 3;       ///< ... or have been observed in so many scans
  double coast_s = 3.0;               ///< a confirmed track is kept for so long without points ...
  double coast_sigma_m = 2.0;         ///< ... while its position is known so well
  double max_spread_mps = 0.4;        ///< points whose velocities differ more from those of a rigid body are no object
  double same_velocity_mps = 0.2;     ///< static points in a new object's box contradict it when they deviate more
  double min_speed_mps = 0.5;         ///< what is slower counts as standing ...
  double stand_s = 60.0;              ///< ... and is no object any more after so long
  double gate_m = 0.5;                ///< points of an object lie so near to its predicted box, beyond its uncertainty
  double gate_mps = 0.5;              ///< and have so nearly its predicted radial velocity, beyond its uncertainty
  double growth_m = 1.0;              ///< parts of the same group become part of the object up to so far from its box
  double slow_mps = 1.0;              ///< objects with less radial speed are looked for among the static points too
  double tangential_sigma_mps = 0.5;  ///< beyond this the velocity across the line of sight is not observed
};

ConfigFields fields(TrackerConfig& config);

}  // namespace dynamic_icp::tracking
