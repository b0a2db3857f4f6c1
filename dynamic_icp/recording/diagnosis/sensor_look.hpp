// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::diagnosis {

/// What one sensor of a rig shows by itself.
struct SensorLook {
  ego_motion::EgoVelocity ego;  ///< in the axes of the scan, its lever arm not taken out
  double static_share = 0.0;    ///< of its points

  /// Root mean square over the lines of sight of the error by direction that velocity and bias leave, m/s.
  double direction_error_mps = 0.0;
  /// (m/s)^2; sqrt(a' M a) is the velocity along the unit vector a that an error by direction as large as the one left
  /// could pretend (Cauchy and Schwarz): little where the sensor sees widely, much across a narrow view.
  Eigen::Matrix3d pretended = Eigen::Matrix3d::Identity();

  /// Whether it is one. Along some directions it may be hardly known: `ego.covariance` and `pretended` say so.
  [[nodiscard]] bool has_velocity() const;
};

/// Each sensor of a rig, in the order of its mountings.
std::vector<SensorLook> look_at_sensors(const Scan& scan, const Workers& workers);

}  // namespace dynamic_icp::diagnosis
