// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/compensated_motion.hpp"

#include <cmath>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/motion/twist.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr double kUnknown_mps = 30.0;
constexpr double kStationary_mps = 0.5;

/// A velocity that no Doppler shows. Should a scan with the sensor's motion in its Doppler follow, its filter begins
/// from this one.
ego_motion::EgoVelocity not_from_doppler(const Eigen::Vector3d& velocity, const Eigen::Matrix3d& covariance) {
  ego_motion::EgoVelocity ego;
  ego.status = ego_motion::EgoVelocityStatus::kFromMotion;
  ego.velocity_sensor = velocity;
  ego.covariance = covariance;
  ego.joint_covariance = ego_motion::EgoPrior::default_covariance();
  ego.joint_covariance.topLeftCorner<3, 3>() = covariance;
  return ego;
}

}  // namespace

std::string compensated_doppler_note() {
  return "the Doppler is compensated: it shows what moves, but not the velocity of the sensor, which is that of the "
         "alignment";
}

ego_motion::EgoVelocity static_frame(const Scan& scan) {
  ego_motion::EgoVelocity ego;
  double squares = 0.0;
  for (const double doppler : scan.doppler()) {
    if (std::abs(doppler) < kStationary_mps) {
      squares += doppler * doppler;
      ++ego.inliers;
    }
  }
  ego.points = scan.size();
  ego.inlier_rms_mps = ego.inliers > 0 ? std::sqrt(squares / static_cast<double>(ego.inliers)) : 0.0;
  return ego;
}

ego_motion::EgoVelocity unknown_velocity() {
  ego_motion::EgoVelocity ego =
      not_from_doppler(Eigen::Vector3d::Zero(), kUnknown_mps * kUnknown_mps * Eigen::Matrix3d::Identity());
  ego.status = ego_motion::EgoVelocityStatus::kNotRun;
  return ego;
}

ego_motion::EgoVelocity propagate(const ego_motion::EgoVelocity& velocity, double dt_s) {
  const double change = kUnmodelledAcceleration_mps2 * dt_s;
  return not_from_doppler(velocity.velocity_sensor,
                          velocity.covariance + change * change * Eigen::Matrix3d::Identity());
}

ego_motion::EgoVelocity velocity_of(const Eigen::Isometry3d& T_source_target, double dt_s,
                                    const Eigen::Matrix3d& R_map_target,
                                    const Eigen::Matrix3d& position_covariance_map) {
  return not_from_doppler(motion::mean_twist(T_source_target, dt_s).tail<3>(),
                          R_map_target.transpose() * position_covariance_map * R_map_target / (dt_s * dt_s));
}

}  // namespace dynamic_icp::odometry
