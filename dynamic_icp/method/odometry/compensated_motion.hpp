// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

// Where the sensor's own motion was taken out of the Doppler before (s = u.v_object), no scan shows how the sensor
// moves: its velocity is that of the alignment before, and as well known as a vehicle's acceleration allows.
namespace dynamic_icp::odometry {

/// Where no scan tells, a vehicle changes its velocity by no more than this.
inline constexpr double kUnmodelledAcceleration_mps2 = 3.0;

/// For assumptions().
std::string compensated_doppler_note();

/// The frame in which the static scene of such a scan is static: no velocity, with the scatter of the points that do
/// not move by half a metre per second.
ego_motion::EgoVelocity static_frame(const Scan& scan);

/// Before the first motion: zero, give or take what any vehicle drives (30 m/s).
ego_motion::EgoVelocity unknown_velocity();

}  // namespace dynamic_icp::odometry
