// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/rig_velocity.hpp"

#include <algorithm>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::odometry {
namespace {

/// [omega; alpha] of a predicted rotation `after_s` after its stamp.
ego_motion::AngularMotion angular_motion(const motion::RotationState& rotation, double after_s) {
  Matrix6d F = Matrix6d::Identity();
  F.topRightCorner<3, 3>() = after_s * Eigen::Matrix3d::Identity();
  ego_motion::AngularMotion motion;
  motion.mean << rotation.omega, rotation.alpha;
  motion.mean = F * motion.mean;
  motion.covariance = F * rotation.covariance.bottomRightCorner<6, 6>() * F.transpose();
  return motion;
}

}  // namespace

ego_motion::RigEstimate RigVelocity::estimate(Scan& scan, ego_motion::DopplerRows& rows, double stamp_s,
                                              const std::optional<motion::RotationState>& expected,
                                              const EgoMotionConfig& config,
                                              const motion::RotationFilterConfig& rotation, const Workers& workers) {
  const std::size_t sensors = scan.mountings().size();
  const double time_s = stamp_s + rows.reference_time_s;
  if (!filtered_ || filtered_->mean.size() != static_cast<Eigen::Index>(6 + sensors)) {
    filtered_ = ego_motion::first_rig_prior(config.drift, sensors);
    time_s_ = time_s;
  }
  const double dt_s = std::clamp(time_s - time_s_, 0.0, kMaxPrediction_s);
  const ego_motion::RigPrior prior = ego_motion::predict(*filtered_, dt_s, config.drift);
  ego_motion::AngularMotion angular =
      angular_motion(expected ? *expected : motion::first_rotation_state(rotation), rows.reference_time_s);
  ego_motion::RigDoppler reduced;
  reduced.reference_time_s = rows.reference_time_s;
  reduced.bias_mps = prior.mean.tail(static_cast<Eigen::Index>(sensors));
  reduced.omega = expected ? Eigen::Vector3d(angular.mean.head<3>())
                           : ego_motion::rig_angular_velocity(scan, config.consensus, config.drift, workers).omega;
  reduced.alpha = angular.mean.tail<3>();

  ego_motion::reduce_to_origin(scan, reduced, workers);
  rows = ego_motion::sort_into_cells(scan, config.consensus.cell_size_m, workers);
  const ego_motion::EgoVelocity start =
      ego_motion::estimate_velocity(rows, ego_motion::as_ego_prior(prior), config.consensus, workers);
  ego_motion::RigEstimate found =
      ego_motion::estimate_rig_motion(scan, reduced, start, prior, angular, config.consensus, config.drift, workers);
  ego_motion::reduce_to_origin(scan, reduced, workers, -1.0);
  ego_motion::reduce_to_origin(scan, found.doppler, workers);
  filtered_ = found.filtered;
  time_s_ = time_s;
  return found;
}

}  // namespace dynamic_icp::odometry
