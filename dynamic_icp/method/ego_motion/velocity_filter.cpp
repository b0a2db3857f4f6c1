// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"

#include <cmath>

namespace dynamic_icp::ego_motion {
ConfigFields fields(VelocityFilterConfig& config) {
  return {
      {"enabled", &config.enabled, 0, 0, "", "classify points as moving or static; off: all count as static"},
      {"tau_0_mps", &config.tau_0_mps, 0.0, 100.0, "m/s",
       "a point moves when its Doppler residual exceeds tau_0 + kappa * distance"},
      {"kappa_per_s", &config.kappa_per_s, 0.0, 10.0, "(m/s)/m", "growth of that threshold with the distance"},
  };
}

std::vector<double> compensated_doppler(const Scan& scan, const Eigen::Vector3d& velocity_sensor) {
  EgoVelocity ego;
  ego.velocity_sensor = velocity_sensor;
  std::vector<double> compensated;
  compensated_doppler(scan, ego, Workers(1), compensated);
  return compensated;
}

void compensated_doppler(const Scan& scan, const EgoVelocity& ego, const Workers& workers,
                         std::vector<double>& compensated) {
  compensated.resize(scan.size());
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const double after = scan.has_times() ? scan.times()[i] - ego.reference_time_s : 0.0;
    const Eigen::Vector3d velocity = ego.velocity_sensor + after * ego.acceleration_sensor;
    compensated[i] = scan.doppler()[i] - ego.bias_mps + scan.directions()[i].dot(velocity);
  });
}

std::vector<std::uint8_t> dynamic_mask(const Scan& scan, const std::vector<double>& compensated,
                                       const VelocityFilterConfig& config) {
  std::vector<std::uint8_t> mask;
  dynamic_mask(scan, compensated, config, Workers(1), mask);
  return mask;
}

void dynamic_mask(const Scan& scan, const std::vector<double>& compensated, const VelocityFilterConfig& config,
                  const Workers& workers, std::vector<std::uint8_t>& mask) {
  mask.assign(scan.size(), 0);
  if (config.enabled) {
    workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
      const double beyond = std::abs(compensated[i]) - config.tau_0_mps;
      const bool moves = beyond > 0.0 && beyond > config.kappa_per_s * scan.points()[i].norm();
      mask[i] = moves ? 1 : 0;
    });
  }
}

}  // namespace dynamic_icp::ego_motion
