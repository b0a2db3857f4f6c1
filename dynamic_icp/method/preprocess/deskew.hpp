// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::preprocess {

/// Undoes the motion of the sensor during the sweep, taken as constant: each point is moved to where it would have been
/// measured at the middle of the scan,
///   p_i <- exp((s_i - 1/2) log(T_begin_end)) p_i,
/// where s_i is the time of the point over the duration of the scan, 0 for the earliest point and 1 for the latest.
/// `T_begin_end` is the pose of the sensor at the end of the sweep in the frame at its begin. Lines of sight and
/// Doppler stay as measured. A scan without times, or with all times equal, is returned as it is.
Scan deskew(const Scan& scan, const Eigen::Isometry3d& T_begin_end);

}  // namespace dynamic_icp::preprocess
