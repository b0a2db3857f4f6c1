// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/doppler_rows.hpp"
#include "dynamic_icp/method/ego_motion/rig_regression.hpp"
#include "dynamic_icp/method/motion/rotation_filter.hpp"
#include "dynamic_icp/method/odometry/config.hpp"

namespace dynamic_icp::odometry {

/// Velocity and angular velocity of a rig of several sensors from the Doppler of its scans, and the constant Doppler
/// error of each sensor, carried on from scan to scan.
class RigVelocity {
 public:
  /// Estimates from the scan at `stamp_s`, and reduces its Doppler to what one sensor at the origin would measure (see
  /// reduce_to_origin). `rows`: the scan by cells; sorted anew. `expected`: the rotation that is predicted for the
  /// stamp, nothing at the first scan.
  ego_motion::RigEstimate estimate(Scan& scan, ego_motion::DopplerRows& rows, double stamp_s,
                                   const std::optional<motion::RotationState>& expected, const EgoMotionConfig& config,
                                   const motion::RotationFilterConfig& rotation, const Workers& workers);

 private:
  std::optional<ego_motion::RigPrior> filtered_;
  double time_s_ = 0.0;  ///< that `filtered_` is about
};

}  // namespace dynamic_icp::odometry
