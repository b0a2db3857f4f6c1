// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::odometry {

/// The motion of the sensor as alignments found it. Where its own motion was taken out of the Doppler before, no scan
/// shows it: preset `paper` then takes the velocity and the start of the next alignment from here. Not in the paper.
class MotionByGeometry {
 public:
  /// Whether a motion has been found.
  [[nodiscard]] bool is_known() const { return twist_.has_value(); }

  /// T_target_source of the same motion over `time_s`; there must be one.
  [[nodiscard]] Eigen::Isometry3d predicted(double time_s) const { return exp_se3(time_s * *twist_); }

  /// Takes over the motion of a frame that was found, or that continues from one that was.
  void update(const Frame& frame, double dt_s);

  /// Aligns without a Doppler term, from the given start; before the first motion is known from one that is searched
  /// for among all that a vehicle can do in `dt_s`.
  [[nodiscard]] registration::Alignment align(const Scan& source, const registration::Target& target,
                                              const Eigen::Isometry3d& T_start, double dt_s,
                                              registration::AlignConfig config, const Workers& workers) const;

  /// `velocity_sensor` (m/s), which is that of the motion, where it is known; else at rest.
  [[nodiscard]] ego_motion::EgoVelocity velocity(const Eigen::Vector3d& velocity_sensor) const;

  void state(StateArchive& archive);

 private:
  std::optional<Vector6d> twist_;  // log(T_target_source) / dt
};

}  // namespace dynamic_icp::odometry
