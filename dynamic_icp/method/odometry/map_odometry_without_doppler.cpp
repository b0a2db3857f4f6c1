// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <Eigen/Eigenvalues>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/map_odometry.hpp"
#include "dynamic_icp/method/registration/translation_search.hpp"

// What the map odometry does where no Doppler tells how the sensor moves: it is compensated, or the scan is unusable.
namespace dynamic_icp::odometry {
namespace {

constexpr double kFirstTranslation_m = 0.2;

// A direction is held when no more than this share of what the points say of it is the noise of normals. Patches that
// are curved or meet an edge err by more: in a smooth tunnel noise is a tenth to all of it, on a street a 400th.
constexpr double kMaxByNoise = 0.04;

}  // namespace

/// Of the second scan in a map, by the points alone: well enough for the alignment to find the rest.
ego_motion::EgoVelocity MapOdometry::first_velocity(const ScanState& now) const {
  const double dt_s = now.stamp_s - state_->stamp_s;
  const registration::PreparedTarget target = registration::search_target(now.static_points, workers_);
  const registration::InitialTranslation found =
      registration::search_translation(state_->first.static_points, target.target(), dt_s, {}, workers_);
  if (!found.is_unambiguous) {
    return now.ego;  // as unknown as it was
  }
  return velocity_of(found.T_target_source.inverse(), dt_s, Eigen::Matrix3d::Identity(),
                     kFirstTranslation_m * kFirstTranslation_m * Eigen::Matrix3d::Identity());
}

/// Without a Doppler that tells: the sensor continues as it moved last, as well as that is known.
void MapOdometry::predict_constant_velocity(const ScanState& now, mapping::MotionPrior& prior) const {
  const double dt_s = now.stamp_s - state_->stamp_s;
  const Eigen::Isometry3d T_now_last = motion::motion_of(state_->rotation.omega, now.ego.velocity_sensor, -dt_s);
  prior.displacement_fixed = state_->T_map_sensor.translation();
  prior.displacement_rotated = -T_now_last.translation();
  prior.translation_covariance = state_->position_covariance +
                                 dt_s * dt_s * prior.R_map_sensor * now.ego.covariance * prior.R_map_sensor.transpose();
}

/// Two rounds without a Doppler that tells: the motion that the first one finds deskews the scan for the
/// second.
mapping::MapAlignment MapOdometry::align_with_found_velocity(const ScanState& now, mapping::MotionPrior prior,
                                                             const mapping::MapAlignConfig& config) const {
  const mapping::MapAlignment found = mapping::align_to_map(now.static_points, map_, prior, config, workers_);
  if (now.duration_s <= 0.0) {
    return found;
  }
  prior.sweep.velocity =
      velocity_of(motion_to(found), now.stamp_s - state_->stamp_s, found.T_map_sensor.linear(), Eigen::Matrix3d::Zero())
          .velocity_sensor;
  return mapping::align_to_map(now.static_points, map_, prior, config, workers_);
}

/// A scan that cannot be used, or one after a long gap: the last motion continues.
void MapOdometry::predict_only(double stamp_s, FrameStatus status, Frame& frame) const {
  const double dt_s = std::min(stamp_s - state_->stamp_s, kMaxPrediction_s);
  const Eigen::Isometry3d T_target_source =
      motion::motion_of(state_->rotation.omega, state_->filtered.velocity_sensor, -dt_s);
  set_motion(frame, status, state_->T_map_sensor, T_target_source);
  const double turned_rad = config_.rotation.start_omega_rad_s * dt_s;
  const double moved_m = 0.5 * kUnmodelledAcceleration_mps2 * dt_s * dt_s;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(turned_rad * turned_rad);
  covariance.diagonal().tail<3>().setConstant(moved_m * moved_m);
  frame.alignment.covariance = covariance;
}

/// What the points say of the position. Where no Doppler tells, it is believed only as far as it is more than the noise
/// of normals: in a tunnel that alone seems to hold the way to some centimetres, and to hold it where the map is.
Eigen::Matrix3d MapOdometry::observed_position_information(const ScanState& now,
                                                           const mapping::MapAlignment& found) const {
  const Eigen::Matrix3d information = motion::position_information(found.geometry_information);
  if (now.is_relative) {
    return information;
  }
  const Eigen::Matrix3d noise =
      mapping::position_information_of_noise(now.static_points, map_, found, config_.map_align, workers_);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(information);
  Eigen::Matrix3d observed = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d direction = parts.eigenvectors().col(k);
    const double by_noise = direction.dot(noise * direction);
    if (by_noise < kMaxByNoise * parts.eigenvalues()[k]) {
      observed += (parts.eigenvalues()[k] - by_noise) * direction * direction.transpose();
    }
  }
  return observed;
}

/// The directions that the points hardly hold.
std::vector<Eigen::Vector3d> MapOdometry::unobservable_directions(const Eigen::Matrix3d& observed) const {
  std::vector<Eigen::Vector3d> directions;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(observed);
  for (int k = 0; k < 3; ++k) {
    if (parts.eigenvalues()[k] * config_.unobservable_sigma_m * config_.unobservable_sigma_m < 1.0) {
      directions.push_back(parts.eigenvectors().col(k));
    }
  }
  return directions;
}

/// Along directions that nothing holds the even motion continues, whatever the noise of normals says.
void MapOdometry::keep_predicted_where_unobservable(const mapping::MotionPrior& prior, const Eigen::Matrix3d& observed,
                                                    mapping::MapAlignment& found) const {
  const Eigen::Vector3d expected = prior.displacement_fixed + found.T_map_sensor.linear() * prior.displacement_rotated;
  for (const Eigen::Vector3d& direction : unobservable_directions(observed)) {
    found.T_map_sensor.translation() -= direction.dot(found.T_map_sensor.translation() - expected) * direction;
  }
}

/// Of the motion that an alignment found. Along directions that the points hardly hold (a tunnel) scan after scan would
/// seem to add to what is known, but errs alike each time: there nothing is learned.
ego_motion::EgoVelocity MapOdometry::found_velocity(const ScanState& now, const mapping::MapAlignment& found,
                                                    const Eigen::Matrix3d& observed) const {
  const double dt_s = now.stamp_s - state_->stamp_s;
  const Eigen::Matrix3d& R_map_sensor = found.T_map_sensor.linear();
  const Eigen::Matrix3d expected = dt_s * dt_s * R_map_sensor * now.ego.covariance * R_map_sensor.transpose();
  Eigen::Matrix3d covariance = found.covariance.block<3, 3>(3, 3);
  for (const Eigen::Vector3d& direction : unobservable_directions(observed)) {
    covariance += direction.dot(expected * direction) * direction * direction.transpose();
  }
  return velocity_of(motion_to(found), dt_s, R_map_sensor, covariance);
}

/// T_last_now.
Eigen::Isometry3d MapOdometry::motion_to(const mapping::MapAlignment& found) const {
  return state_->T_map_sensor.inverse() * found.T_map_sensor;
}

}  // namespace dynamic_icp::odometry
