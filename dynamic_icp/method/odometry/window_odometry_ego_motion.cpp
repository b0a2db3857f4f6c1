// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT

// Preset `default`: what stands and what moves, by the Doppler.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/creeping_cells.hpp"
#include "dynamic_icp/method/ego_motion/rig_doppler.hpp"
#include "dynamic_icp/method/ego_motion/support_velocity.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/window_odometry.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr double kAccelerationSigma_mps2 = 3.0;
constexpr double kNoBias_mps = 1e-3;

// So long after the beginning much that passes for static may move: of the points that lie so near a plane of the map
// this share, in which no traffic lies that was known to move.
constexpr double kBeginning_s = 1.0;
constexpr double kOnPlane_m = 0.2;
constexpr double kMisled = 0.25;

}  // namespace

/// What the rotation adds to the Doppler of the sensors of a rig: the consensus is about one velocity.
void WindowOdometry::take_out_lever_arms() {
  Scan& whole = memory_.whole;
  lever_arm_omega_.reset();
  if (!whole.is_of_rig() || whole.doppler_kind() != DopplerKind::kRelative) {
    return;
  }
  rig_rotation_ = ego_motion::rig_angular_velocity(whole, config_.ego_motion.consensus, workers_);
  lever_arm_omega_ = estimator_.scans() > 0 ? estimator_.trajectory().at_end().omega : rig_rotation_.omega;
  ego_motion::take_out_lever_arms(whole, *lever_arm_omega_, workers_);
}

ego_motion::EgoPrior WindowOdometry::ego_prior() const {
  ego_motion::EgoPrior prior;
  if (estimator_.scans() > 0) {
    const double changed_mps = kAccelerationSigma_mps2 * (stream_.elapsed_s() - stamp_s_);
    prior.has_velocity = true;
    prior.mean.head<3>() = estimator_.trajectory().at_end().velocity;
    prior.covariance.setZero();
    prior.covariance.topLeftCorner<3, 3>() = estimator_.twist().covariance.bottomRightCorner<3, 3>();
    prior.covariance.diagonal().head<3>().array() += changed_mps * changed_mps;
    prior.covariance.diagonal().segment<3>(3).setConstant(kAccelerationSigma_mps2 * kAccelerationSigma_mps2);
  }
  prior.covariance(6, 6) = kNoBias_mps * kNoBias_mps;
  return prior;
}

/// Before the Doppler tells: the velocity at the end of the trajectory.
ego_motion::EgoVelocity WindowOdometry::velocity_before() const {
  ego_motion::EgoVelocity ego = unknown_velocity();
  if (estimator_.scans() > 1) {
    ego.velocity_sensor = estimator_.trajectory().at_end().velocity;
  }
  return ego;
}

/// The sensor during the scan at hand, with this velocity (m/s) and turning as it did.
tracking::SensorMotion WindowOdometry::predicted_motion(const Eigen::Vector3d& velocity_sensor) const {
  if (estimator_.scans() == 0) {
    return {T_world_sensor_};
  }
  const window::TrajectoryPoint last = estimator_.trajectory().at_end();
  const double dt_s = stream_.elapsed_s() - stamp_s_;
  return tracking::motion_at(T_world_sensor_ * motion::motion_of(last.omega, velocity_sensor, dt_s), last.omega,
                             velocity_sensor);
}

/// The rows of the scan at hand that vote on what stands: not those where a track expects its object. In a jam traffic
/// has far more points than what stands, and moves hardly faster.
const ego_motion::DopplerRows& WindowOdometry::rows_to_vote() {
  if (estimator_.scans() < 2) {
    return memory_.rows;
  }
  const Scan& whole = memory_.whole;
  const ego_motion::EgoVelocity expected = velocity_before();
  ego_motion::compensated_doppler(whole, expected, workers_, memory_.radial);
  memory_.is_moving.assign(whole.size(), 0);
  tracker_.flag_expected(whole, memory_.patches, memory_.radial, predicted_motion(expected.velocity_sensor), workers_,
                         memory_.is_moving);
  if (std::ranges::count(memory_.is_moving, 1) == 0) {
    return memory_.rows;
  }
  ego_motion::without_rows(memory_.rows, memory_.sort, memory_.is_moving, memory_.voting_rows);
  return memory_.voting_rows;
}

/// What is static, by the velocity that most of the scene agrees on and by what was seen to move.
void WindowOdometry::separate_static_points() {
  const Scan& whole = memory_.whole;
  const bool is_relative = whole.doppler_kind() == DopplerKind::kRelative;
  memory_.patches.bound(whole, workers_);
  const ego_motion::EgoPrior prior = ego_prior();
  ego_ = is_relative ? ego_motion::estimate_velocity(rows_to_vote(), prior, config_.ego_motion.consensus, workers_)
                     : velocity_before();
  if (is_relative && support_) {
    const Eigen::Vector3d of_support =
        ego_motion::support_velocity(memory_.rows, ego_, support_->normal, noise_for(ego_), filter_for(ego_).tau_0_mps);
    // Roofs of traffic may look like what carries the scene where hardly any of that is seen.
    if (!prior.has_velocity || ego_motion::agrees(prior, of_support)) {
      ego_.velocity_sensor = of_support;
    } else {
      support_.reset();
      memory_.rows.on_support.clear();
    }
  }
  if (lever_arm_omega_) {
    ego_.rotation = rig_rotation_;
  }
  clear_scans_ = ego_.status == ego_motion::EgoVelocityStatus::kAmbiguous ? 0 : std::min(kClearScans, clear_scans_ + 1);
  const ego_motion::EgoVelocity in_doppler = is_relative ? ego_ : static_frame(whole);
  ego_motion::compensated_doppler(whole, in_doppler, workers_, memory_.radial);
  ego_motion::dynamic_mask(whole, memory_.radial, filter_for(in_doppler), workers_, memory_.is_moving);
  if (is_relative && config_.ego_motion.filter.enabled) {
    const std::vector<std::uint8_t> creeps = ego_motion::creeping_cells(
        memory_.rows, ego_, noise_for(ego_), filter_for(ego_).tau_0_mps, config_.ego_motion.static_sigmas);
    workers_.for_each(whole.size(), kPointBlock,
                      [&](std::size_t i) { memory_.is_moving[i] |= creeps[memory_.sort.cell[i]]; });
  }
  tracker_.flag_expected(whole, memory_.patches, memory_.radial, predicted_motion(ego_.velocity_sensor), workers_,
                         memory_.is_moving);
  if (lever_arm_omega_) {
    ego_motion::take_out_lever_arms(memory_.whole, *lever_arm_omega_, workers_, -1.0);
  }
  static_points_ = whole.select(static_rows(memory_.thinned, memory_.is_moving));
}

/// Whether much of the map moves. As long as the errors of the Doppler are not known, traffic that creeps beside the
/// sensor may pass for static, and what is learned of the motion and the sensor then is wrong.
bool WindowOdometry::was_misled() const {
  if (estimator_.is_calibrated() || stream_.elapsed_s() > kBeginning_s) {
    return false;
  }
  const Eigen::Isometry3d T_map_sensor = predicted_motion(ego_.velocity_sensor).T_world_sensor;
  std::size_t standing = 0;
  std::size_t moving = 0;
  for (const std::uint32_t row : memory_.thinned) {
    const Eigen::Vector3d point = T_map_sensor * memory_.whole.points()[row];
    const mapping::Patch* const patch = map_.find(map_.finest_cell(point));
    if (patch != nullptr && std::abs(patch->plane.distance(point)) < kOnPlane_m) {
      ++(memory_.is_moving[row] != 0 ? moving : standing);
    }
  }
  return static_cast<double>(moving) > kMisled * static_cast<double>(moving + standing);
}

/// The velocity as it is known now, and what moves against it.
void WindowOdometry::judge_points(const window::WindowScan& now) {
  const motion::SweepMotion sweep = sweep_of(now);
  ego_.velocity_sensor = sweep.velocity_at(ego_.reference_time_s);
  ego_.acceleration_sensor = sweep.acceleration;
  ego_.covariance = estimator_.twist().covariance.bottomRightCorner<3, 3>();
  const std::vector<double>& errors = memory_.errors.learned;
  ego_.bias_mps =
      std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, errors.size()));
  if (now.measured == nullptr) {
    ego_.status = ego_motion::EgoVelocityStatus::kFromMotion;
    ego_.unobservable.setZero();
    memory_.may_be_object = memory_.is_moving;
    return;
  }
  const Scan& whole = memory_.whole;
  estimator_.static_doppler(whole, workers_, memory_.predicted);
  workers_.for_each(whole.size(), kPointBlock,
                    [&](std::size_t i) { memory_.radial[i] = memory_.measured[i] - errors[i] - memory_.predicted[i]; });
  ego_motion::dynamic_mask(whole, memory_.radial, filter_for(ego_), workers_, memory_.is_moving);
  memory_.may_be_object = memory_.is_moving;
  // The map takes in nothing of what objects are about to cross.
  tracker_.flag_expected(whole, memory_.patches, memory_.radial,
                         tracking::motion_at(T_world_sensor_, sweep.omega, sweep.velocity), workers_,
                         memory_.is_moving);
}

/// Standard deviation of the Doppler of a point, m/s.
double WindowOdometry::noise_for(const ego_motion::EgoVelocity& ego) const {
  return estimator_.point_noise().value_or(ego.inlier_rms_mps);
}

/// The threshold of the velocity filter, never less than what the noise of static points reaches now and then.
ego_motion::VelocityFilterConfig WindowOdometry::filter_for(const ego_motion::EgoVelocity& ego) const {
  ego_motion::VelocityFilterConfig filter = config_.ego_motion.filter;
  filter.tau_0_mps = std::max(filter.tau_0_mps, config_.ego_motion.static_sigmas * noise_for(ego));
  return filter;
}

}  // namespace dynamic_icp::odometry
