// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

// A rig is followed at the middle of its sensors: there the Doppler shows the velocity whatever the rig rotates, while
// that of an origin some metres away is only known as well as the rotation.
namespace dynamic_icp::odometry {

/// The middle of the sensors, m, in the common frame of a scan.
Eigen::Vector3d middle_of_sensors(const Scan& scan);

/// The frame as seen from the origin of the recording, of one that was computed with the origin at `middle`: poses,
/// covariances, velocities and places. Both worlds have the axes of their first scan and begin at its origin.
Frame seen_from_origin(Frame frame, const Eigen::Vector3d& middle);

}  // namespace dynamic_icp::odometry
