// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/sweep_motion.hpp"

namespace dynamic_icp::motion {

Eigen::Matrix3d SweepMotion::rotation(double tau) const { return exp_so3(tau * omega + 0.5 * tau * tau * alpha); }

Eigen::Isometry3d SweepMotion::pose(double tau) const {
  Eigen::Isometry3d T_stamp_tau = Eigen::Isometry3d::Identity();
  if (tau == 0.0) {
    return T_stamp_tau;
  }
  T_stamp_tau.linear() = rotation(tau);
  const Eigen::Vector3d middle = rotation(0.5 * tau) * velocity_at(0.5 * tau);
  T_stamp_tau.translation() = tau / 6.0 * (velocity + 4.0 * middle + T_stamp_tau.linear() * velocity_at(tau));
  return T_stamp_tau;
}

}  // namespace dynamic_icp::motion
