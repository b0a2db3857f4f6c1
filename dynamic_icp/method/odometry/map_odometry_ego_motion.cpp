// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

// Preset `fast`: the velocity of the sensor from its Doppler, and what is static.
#include <algorithm>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/map_odometry.hpp"

namespace dynamic_icp::odometry {
namespace {

/// The threshold of the velocity filter, never less than what the noise of static points reaches now and then.
ego_motion::VelocityFilterConfig filter_for(const EgoMotionConfig& config, const ego_motion::EgoVelocity& ego) {
  ego_motion::VelocityFilterConfig filter = config.filter;
  filter.tau_0_mps = std::max(filter.tau_0_mps, config.static_sigmas * ego.inlier_rms_mps);
  return filter;
}

}  // namespace

/// The velocity of the sensor at this scan, and the points that are static.
MapOdometry::ScanState MapOdometry::separate_static_points() {
  const Scan& whole = memory_.whole;
  ScanState now;
  now.stamp_s = stream_.elapsed_s();
  now.middle_s = memory_.rows.reference_time_s;
  now.duration_s = memory_.rows.duration_s;
  now.is_relative = whole.doppler_kind() == DopplerKind::kRelative;
  if (now.is_relative && whole.is_of_rig() && config_.ego_motion.use_consensus) {
    const ego_motion::RigEstimate rig = estimate_rig(now.stamp_s);
    now.ego = rig.ego;
    now.filtered = rig.ego;
    now.rotation = rig.rotation;
  } else {
    now.filtered = estimate_ego(now.stamp_s);
    now.ego =
        now.is_relative ? ego_motion::average_over_bias_models(now.filtered, config_.ego_motion.drift) : now.filtered;
  }
  const ego_motion::EgoVelocity in_doppler = now.is_relative ? now.ego : static_frame(whole);
  ego_motion::compensated_doppler(whole, in_doppler, workers_, memory_.radial);
  ego_motion::dynamic_mask(whole, memory_.radial, filter_for(config_.ego_motion, in_doppler), workers_,
                           memory_.is_moving);
  now.static_points = whole.select(static_rows(memory_.thinned, memory_.is_moving));
  return now;
}

ego_motion::EgoVelocity MapOdometry::estimate_ego(double stamp_s) const {
  const EgoMotionConfig& config = config_.ego_motion;
  const Scan& scan = memory_.whole;
  const ego_motion::DopplerRows& rows = memory_.rows;
  if (scan.doppler_kind() == DopplerKind::kCompensated) {
    return state_ ? propagate(state_->filtered, stamp_s - state_->stamp_s) : unknown_velocity();
  }
  if (!config.use_consensus) {
    const Eigen::Vector3d start = state_ ? state_->filtered.velocity_sensor : Eigen::Vector3d::Zero();
    ego_motion::EgoVelocity ego = ego_motion::estimate_velocity(scan, start, config.regression, workers_);
    ego.reference_time_s = rows.reference_time_s;
    return ego;
  }
  const double dt_s =
      state_ ? std::min(stamp_s + rows.reference_time_s - state_->velocities.back().time_s, kMaxPrediction_s) : 0.0;
  const ego_motion::EgoPrior prior =
      state_ ? ego_motion::predict(state_->filtered, dt_s, config.drift) : ego_motion::first_prior(config.drift);
  return ego_motion::estimate_velocity(rows, prior, config.consensus, workers_);
}

/// The same of a rig, whose Doppler is that of its origin from here on.
ego_motion::RigEstimate MapOdometry::estimate_rig(double stamp_s) {
  std::optional<motion::RotationState> expected;
  if (state_) {
    expected = motion::predict(state_->rotation, stamp_s - state_->stamp_s, config_.rotation);
  }
  return rig_.estimate(memory_.whole, memory_.rows, stamp_s, expected, config_.ego_motion, config_.rotation, workers_);
}

}  // namespace dynamic_icp::odometry
