// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

struct VelocityFilterConfig {
  bool enabled = true;  ///< off: every point counts as static (ablation "w/o VF")
  double tau_0_mps = 0.35;
  double kappa_per_s = 0.005;  ///< (m/s) per metre of distance
};

ConfigFields fields(VelocityFilterConfig& config);

/// Doppler velocity with the sensor's own motion taken out, s~_i = s_i + u_i . v, of the paper's Eq. (4): the residual
/// r_i of the velocity filter and the measurement of the object velocities (m/s, positive away from the sensor).
std::vector<double> compensated_doppler(const Scan& scan, const Eigen::Vector3d& velocity_sensor);

/// The same with all that is known of the sensor's motion: its acceleration during the scan and the bias of the
/// Doppler, s_i + u_i . v(tau_i) - bias.
void compensated_doppler(const Scan& scan, const EgoVelocity& ego, const Workers& workers,
                         std::vector<double>& compensated);

/// Which points move: 1 where |r_i| > tau(d_i) = tau_0 + kappa d_i with the distance d_i of the point, 0 elsewhere.
std::vector<std::uint8_t> dynamic_mask(const Scan& scan, const std::vector<double>& compensated,
                                       const VelocityFilterConfig& config);
void dynamic_mask(const Scan& scan, const std::vector<double>& compensated, const VelocityFilterConfig& config,
                  const Workers& workers, std::vector<std::uint8_t>& mask);

}  // namespace dynamic_icp::ego_motion
