// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

/// The velocity of the sensor (m/s, sensor axes) by the surface that carries the scene alone, which does not move where
/// nearly all else does:
///   min over v of sum_c rho(off_c + u_c . (v - v_ego)) / (scale^2 + variance_c) + |v - v_ego|^2 / (0.5 m/s)^2
///                 + (n . v)^2 / ((0.2 m/s)^2 + (0.1 |v_ego|)^2)
/// over the cells on it, with the means of doppler_of_cell, Tukey's rho and the normal n of the surface (sensor axes),
/// along which the sensor hardly moves. That of `ego` where too few cells are on it or it is not known. For `noise_mps`
/// and `moving_mps` see there.
Eigen::Vector3d support_velocity(const DopplerRows& rows, const EgoVelocity& ego, const Eigen::Vector3d& normal,
                                 double noise_mps, double moving_mps);

}  // namespace dynamic_icp::ego_motion
