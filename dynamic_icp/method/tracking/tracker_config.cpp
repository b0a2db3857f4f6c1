// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp::tracking {

ConfigFields fields(TrackConfig& config) {
  ConfigFields all = {
      {"doppler_sigma_mps", &config.doppler_sigma_mps, 1e-4, 10.0, "m/s", "noise of the Doppler of one point"},
      {"doppler_floor_mps", &config.doppler_floor_mps, 0.0, 10.0, "m/s",
       "error of the Doppler that all points of an object share, and of the mean of those of its beams"},
      {"sway_rps", &config.sway_rps, 0.0, 10.0, "rad/s", "roll and pitch rates of objects, taken as noise"},
      {"face_sigma_m", &config.face_sigma_m, 1e-3, 10.0, "m", "noise of where a side of an object is seen"},
      {"face_sigma_growth", &config.face_sigma_growth, 0.0, 1.0, "m/m", "growth of that noise with the range"},
      {"yaw_sigma_rad", &config.yaw_sigma_rad, 1e-4, 3.0, "rad",
       "difference between the direction of an object's sides and of its motion"},
      {"prior_speed_mps", &config.prior_speed_mps, 0.1, 1000.0, "m/s", "typical horizontal speed of new objects"},
      {"prior_yaw_rate_rps", &config.prior_yaw_rate_rps, 1e-3, 100.0, "rad/s", "typical yaw rate of new objects"},
      {"largest_width_m", &config.largest_width_m, 0.0, 100.0, "m", "greatest likely width of vehicles"},
  };
  append_fields(all, "motion", fields(config.motion));
  return all;
}

ConfigFields fields(TrackerConfig& config) {
  ConfigFields all = {
      {"min_range_m", &config.min_range_m, 0.0, 100.0, "m",
       "what is nearer to its sensor belongs to the vehicle that carries it, or is its window"},
      {"min_points", &config.min_points, 1, 1e6, "", "moving points that initiate a track"},
      {"confirm_points", &config.confirm_points, 1, 1e6, "", "moving points that confirm a track in its first scan"},
      {"confirm_scans", &config.confirm_scans, 1, 1000, "", "scans in which a smaller object must be detected"},
      {"confirm_sigma_mps", &config.confirm_sigma_mps, 0.0, 1000.0, "m/s",
       "a track is confirmed when the standard deviation of its horizontal velocity is below this"},
      {"confirm_anyway_scans", &config.confirm_anyway_scans, 1, 1000, "",
       "or when it has been seen in so many scans, however well its velocity and its heading are known"},
      {"coast_s", &config.coast_s, 0.0, 1000.0, "s", "time for which a track is kept without detections"},
      {"coast_sigma_m", &config.coast_sigma_m, 0.0, 1000.0, "m",
       "largest standard deviation of the position of such a track"},
      {"max_spread_mps", &config.max_spread_mps, 0.0, 100.0, "m/s",
       "points are no object when their radial velocities differ by more from those of a rigid body"},
      {"same_velocity_mps", &config.same_velocity_mps, 0.0, 100.0, "m/s",
       "static points in the box of a new object contradict it when their radial velocity differs by more"},
      {"min_speed_mps", &config.min_speed_mps, 0.0, 100.0, "m/s", "objects slower than this count as stationary"},
      {"stand_s", &config.stand_s, 0.0, 1e6, "s", "time for which an object that stands is kept"},
      {"gate_m", &config.gate_m, 0.0, 100.0, "m", "association gate: distance of points from the predicted box"},
      {"gate_mps", &config.gate_mps, 0.0, 100.0, "m/s",
       "association gate: difference of their radial velocity from the predicted one"},
      {"growth_m", &config.growth_m, 0.0, 100.0, "m", "distance from the box up to which it takes in linked points"},
      {"slow_mps", &config.slow_mps, 0.0, 100.0, "m/s",
       "objects with less radial speed are looked for among static points too"},
      {"tangential_sigma_mps", &config.tangential_sigma_mps, 0.0, 1000.0, "m/s",
       "largest standard deviation at which the velocity across the line of sight counts as observed"},
  };
  append_fields(all, "grouping", fields(config.grouping));
  append_fields(all, "track", fields(config.track));
  return all;
}

}  // namespace dynamic_icp::tracking
