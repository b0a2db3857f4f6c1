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
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

// The Doppler of a rig: several sensors k at l_k in the common frame of their points. A static point shows
//   s = -u . (v + omega x l_k),
// v, omega: velocity and angular velocity of the common frame. The lever arms make omega observable, but along the line
// through two sensors.
namespace dynamic_icp::ego_motion {

/// The rows of a rig's scan that each of its sensors measured.
std::vector<std::vector<std::uint32_t>> rows_by_sensor(const Scan& scan);

/// Takes the lever arms out of the Doppler: what is left, s + u . (omega x l_k) with omega in rad/s, is the Doppler of
/// one sensor at the origin along the same line of sight. With `sign` -1 puts them back.
void take_out_lever_arms(Scan& scan, const Eigen::Vector3d& omega, const Workers& workers, double sign = 1.0);

/// Angular velocity of a rig of which nothing is known, from the velocities that each of its sensors shows alone:
/// v_k = v + omega x l_k, with omega near zero where the lever arms leave it open.
AngularVelocity rig_angular_velocity(const Scan& scan, const ConsensusRegressionConfig& config, const Workers& workers);

/// The same where these velocities are known already: one per mounting, in the axes of the common frame.
AngularVelocity rig_angular_velocity(std::span<const Eigen::Isometry3d> mountings,
                                     std::span<const EgoVelocity> of_sensors);

}  // namespace dynamic_icp::ego_motion
