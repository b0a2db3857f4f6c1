// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/compensated_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"
#include "dynamic_icp/method/preprocess/voxel_grid.hpp"
#include "dynamic_icp/method/registration/way_search.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr double kUnknown_mps = 30.0;
constexpr double kStill_mps = 0.5;
constexpr double kFastest_mps = 45.0;
constexpr double kLeastReach_m = 0.8;
constexpr double kMostReach_m = 10.0;
constexpr double kTargetVoxel_m = 0.4;

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

std::string compensated_sentence() {
  return "the Doppler is compensated: it shows what moves, but not the velocity of the sensor, which is that of the "
         "alignment";
}

ego_motion::EgoVelocity at_rest(const Scan& scan) {
  ego_motion::EgoVelocity ego;
  double squares = 0.0;
  for (const double doppler : scan.doppler()) {
    if (std::abs(doppler) < kStill_mps) {
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

ego_motion::EgoVelocity goes_on(const ego_motion::EgoVelocity& velocity, double dt_s) {
  const double change = kBlindAcceleration_mps2 * dt_s;
  return not_from_doppler(velocity.velocity_sensor,
                          velocity.covariance + change * change * Eigen::Matrix3d::Identity());
}

ego_motion::EgoVelocity velocity_of(const Eigen::Isometry3d& T_source_target, double dt_s,
                                    const Eigen::Matrix3d& R_map_target,
                                    const Eigen::Matrix3d& position_covariance_map) {
  const Vector6d twist = log_se3(T_source_target) / dt_s;
  return not_from_doppler(twist.tail<3>(),
                          R_map_target.transpose() * position_covariance_map * R_map_target / (dt_s * dt_s));
}

FirstWay first_way(const Scan& source, const registration::Target& target, double dt_s, const Workers& workers) {
  const std::array<Eigen::Vector3d, 3> axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                               Eigen::Vector3d::UnitZ()};
  const double reach_m = std::clamp(kFastest_mps * dt_s, kLeastReach_m, kMostReach_m);
  const std::vector<registration::WayCandidate> ways =
      registration::search_ways(source, target, axes, reach_m, workers);
  return {registration::best_way(ways).T_target_source, registration::is_clear(ways)};
}

FirstWay first_way(const Scan& source, const Scan& target, double dt_s, const Workers& workers) {
  const Scan points = preprocess::voxel_grid(target, {kTargetVoxel_m}, workers);
  const spatial::KdTree tree(points.points(), workers);
  const preprocess::Normals normals = preprocess::estimate_normals(points.points(), tree, {}, workers);
  return first_way(source, {points, tree, normals.vectors, normals.valid}, dt_s, workers);
}

Eigen::Isometry3d even_motion(const Eigen::Vector3d& velocity, const Eigen::Vector3d& omega, double dt_s) {
  Vector6d twist;
  twist << omega, velocity;
  return exp_se3(dt_s * twist);
}

}  // namespace dynamic_icp::odometry
