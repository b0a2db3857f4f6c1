// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/tracking/motion_filter.hpp"
#include "dynamic_icp/method/tracking/moving_cells.hpp"

namespace dynamic_icp::tracking {

/// How well one scan measures an object, and what is taken for likely of objects never seen before.
struct TrackConfig {
  MotionNoise motion;
  double doppler_sigma_mps = 0.05;   ///< of one point
  double doppler_floor_mps = 0.03;   ///< error all points of an object share
  double sway_rps = 0.02;            ///< roll and pitch rate of objects, which the state does not hold
  double face_sigma_m = 0.04;        ///< of a side of the box, at the sensor
  double face_sigma_growth = 0.002;  ///< m per metre of range
  double yaw_sigma_rad = 0.05;       ///< between the sides of a body and its motion
  double prior_speed_mps = 20.0;     ///< standard deviation of either horizontal part of a velocity
  double prior_climb_mps = 0.7;      ///< standard deviation of the vertical part: objects move nearly horizontally
  double prior_yaw_rate_rps = 0.2;   ///< standard deviation
  double vehicle_width_m = 1.4;      ///< what is at least so wide is taken for a vehicle ...
  double largest_width_m = 2.6;      ///< no vehicle is wider
  double vehicle_length_m = 4.2;     ///< ... at least so long, though the end may be hidden
};

ConfigFields fields(TrackConfig& config);

struct TrackerConfig {
  GroupingConfig grouping;
  TrackConfig track;
  int min_points = 10;                ///< a group of fewer points is no object
  int confirm_points = 40;            ///< so many points at once confirm an object in its first scan
  int confirm_scans = 2;              ///< else it takes so many scans with points
  double confirm_sigma_mps = 3.0;     ///< and its velocity must be known so well ...
  int confirm_anyway_scans = 3;       ///< ... or have been observed in so many scans
  int coast_scans = 5;                ///< a confirmed track is kept for so many scans without points
  double max_spread_mps = 0.4;        ///< points whose velocities differ more from those of a rigid body are no object
  double same_velocity_mps = 0.2;     ///< static points in a new object's box contradict it when they deviate more
  double min_speed_mps = 0.5;         ///< what is slower counts as standing
  double gate_m = 0.5;                ///< points of an object lie so near to its predicted box, beyond its uncertainty
  double gate_mps = 0.5;              ///< and have so nearly its predicted radial velocity, beyond its uncertainty
  double growth_m = 1.0;              ///< parts of the same group become part of the object up to so far from its box
  double slow_mps = 1.0;              ///< objects with less radial speed are looked for among the static points too
  double tangential_sigma_mps = 1.0;  ///< beyond this the velocity across the line of sight is not observed
};

ConfigFields fields(TrackerConfig& config);

}  // namespace dynamic_icp::tracking
