// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"
#include "dynamic_icp/method/estimation/normal_equations.hpp"
#include "dynamic_icp/method/motion/rotation_filter.hpp"
#include "dynamic_icp/method/motion/twist.hpp"

// How well the motion between two scans is known.
namespace dynamic_icp::motion {

/// What two scans say of the motion between them; all in map axes.
struct MotionEvidence {
  Eigen::Matrix3d source_rotation_covariance = Eigen::Matrix3d::Zero();   ///< rad^2, of R_map_source
  Eigen::Matrix3d target_rotation_covariance = Eigen::Matrix3d::Zero();   ///< rad^2, of R_map_target
  Eigen::Matrix3d displacement_covariance = Eigen::Matrix3d::Zero();      ///< m^2, from the Doppler velocities
  Eigen::Matrix3d source_position_information = Eigen::Matrix3d::Zero();  ///< 1/m^2, from the points of the scan
  Eigen::Matrix3d target_position_information = Eigen::Matrix3d::Zero();
  /// m, target axes: the part of the displacement by the velocity of the target scan, which turns with its rotation.
  Eigen::Vector3d displacement_rotated = Eigen::Vector3d::Zero();
};

/// Covariance of the left perturbation [omega (rad); rho (m)] of T_target_source, in target axes.
///
/// The rotations of both scans were found against the map, one by one: their covariances add up. The displacement is
/// known from the velocities and from the difference of the two positions in the map; these add up by information. An
/// error omega of the rotation turns the displacement q that was measured in target axes: rho = omega x q + ...
Matrix6d motion_covariance(const MotionEvidence& evidence, const Eigen::Matrix3d& R_map_target);

/// What the points of a scan say of its position when nothing is known of its rotation: the Schur complement of the
/// information of [rotation; position].
Eigen::Matrix3d position_information(const Matrix6d& information);

/// The directions [omega * length_m; rho] (m) along which a motion is known worse than `deviation_m`, worst first; with
/// their share of the information of the best known direction.
std::vector<estimation::DegenerateDirection> unobservable_directions(const Matrix6d& covariance, double length_m,
                                                                     double deviation_m);

/// Least over best known direction of a motion, as a ratio of their information.
double information_ratio(const Matrix6d& covariance, double length_m);

/// The twist at the stamp from the angular velocity there and the velocity in the middle of the scan.
Twist twist_at_stamp(const RotationState& rotation, const ego_motion::EgoVelocity& ego, double middle_s);

}  // namespace dynamic_icp::motion
