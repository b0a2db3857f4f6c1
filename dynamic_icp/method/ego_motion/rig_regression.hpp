// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/ego_filter.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

// The Doppler of a rig: several sensors k at l_k in the common frame of their points. A static point shows
//   s = -u . (v + a dt + (omega + alpha dt) x l_k) + b_k,
// v, a, omega, alpha: velocity, acceleration, angular velocity and acceleration of the common frame at the reference
// time, b_k: constant error of the Doppler of sensor k. The lever arms make omega observable, but along the line
// through two sensors.
namespace dynamic_icp::ego_motion {

/// The rows of a rig's scan that each of its sensors measured.
std::vector<std::vector<std::uint32_t>> rows_by_sensor(const Scan& scan);

/// What is in the Doppler of a rig beside the velocity of its origin.
struct RigDoppler {
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  ///< rad/s, at the reference time
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();  ///< rad/s^2
  double reference_time_s = 0.0;                    ///< after the stamp
  Eigen::VectorXd bias_mps;                         ///< one per sensor
};

/// Takes lever arms and errors out of the Doppler: what is left, s + u . ((omega + alpha dt) x l_k) - b_k, is the
/// Doppler of one sensor at the origin along the same line of sight. With `sign` -1 puts them back.
void reduce_to_origin(Scan& scan, const RigDoppler& rig, const Workers& workers, double sign = 1.0);

/// What is known of [v; a; b_1 .. b_K] before the scan is looked at.
struct RigPrior {
  bool has_velocity = false;   ///< off: nothing is known of v
  Eigen::VectorXd mean;        ///< 6 + K
  Eigen::MatrixXd covariance;  ///< definite
};

RigPrior first_rig_prior(const DriftConfig& config, std::size_t sensors);

/// Angular velocity and acceleration (rad/s, rad/s^2; axes of the common frame) at the reference time.
struct AngularMotion {
  Vector6d mean = Vector6d::Zero();  ///< [omega; alpha]
  Matrix6d covariance = Matrix6d::Identity();
};

/// What a scan alone says of [omega; alpha]: nothing along the null space of `information`.
struct AngularInformation {
  Vector6d at = Vector6d::Zero();               ///< [omega; alpha] around which it is stated
  Matrix6d information = Matrix6d::Zero();      ///< inverse covariance
  Vector6d weighted_change = Vector6d::Zero();  ///< information * (most likely [omega; alpha] - at)
};

struct RigEstimate {
  EgoVelocity ego;              ///< v and a; its bias is 0: those of the sensors are in `doppler`
  RigDoppler doppler;           ///< as estimated, biases averaged over whether the sensors are calibrated
  AngularInformation rotation;  ///< for the rotation filter
  RigPrior filtered;            ///< mean and covariance of [v; a; b] to be carried on
};

/// Angular velocity of a rig of which nothing is known, from the velocities that each of its sensors shows alone:
/// v_k = v + omega x l_k, with omega near zero where the lever arms leave it open.
AngularVelocity rig_angular_velocity(const Scan& scan, const ConsensusRegressionConfig& config,
                                     const DriftConfig& drift, const Workers& workers);

/// The same where these velocities are known already: one per mounting, in the axes of the common frame.
AngularVelocity rig_angular_velocity(std::span<const Eigen::Isometry3d> mountings,
                                     std::span<const EgoVelocity> of_sensors);

/// Fits v, a, omega, alpha and b jointly to the rows near `start`, the velocity that the consensus regression found in
/// `scan`, which is reduced to the origin by `reduced`. Tukey's kernel; residuals of one sensor may depend on each
/// other within a direction sector, which counts in weights and covariance; `expected`: what is known of the rotation
/// from elsewhere. `ego.rotation` is omega by the Doppler alone. Where `start` is no velocity that was found, it is
/// returned and nothing else is learned.
RigEstimate estimate_rig_motion(const Scan& scan, const RigDoppler& reduced, const EgoVelocity& start,
                                const RigPrior& prior, const AngularMotion& expected,
                                const ConsensusRegressionConfig& config, const DriftConfig& drift,
                                const Workers& workers);

/// What the estimate says of a scan that is taken `dt_s` later; see `predict` of ego_filter.hpp.
RigPrior predict(const RigPrior& filtered, double dt_s, const DriftConfig& config);

/// v, a of a rig and no bias, as the prior of the consensus regression of a scan that is reduced to the origin.
EgoPrior as_ego_prior(const RigPrior& prior);

}  // namespace dynamic_icp::ego_motion
