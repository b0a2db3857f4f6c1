// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/ego_motion/velocity_filter.hpp"

#include <cmath>

namespace dynamic_icp::ego_motion {

ConfigFields fields(VelocityFilterConfig& config) {
  return {
      {"enabled", &config.enabled, 0, 0, "", "tell moving points from static ones; off: all count as static"},
      {"tau_0_mps", &config.tau_0_mps, 0.0, 100.0, "m/s",
       "a point moves when its Doppler residual exceeds tau_0 + kappa * distance"},
      {"kappa_per_s", &config.kappa_per_s, 0.0, 10.0, "(m/s)/m", "growth of that threshold with the distance"},
  };
}

std::vector<double> compensated_doppler(const Scan& scan, const Eigen::Vector3d& velocity_sensor) {
  std::vector<double> compensated(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    compensated[i] = scan.doppler()[i] + scan.directions()[i].dot(velocity_sensor);
  }
  return compensated;
}

std::vector<double> compensated_doppler(const Scan& scan, const EgoVelocity& ego) {
  std::vector<double> compensated(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double after = scan.has_times() ? scan.times()[i] - ego.reference_time_s : 0.0;
    const Eigen::Vector3d velocity = ego.velocity_sensor + after * ego.acceleration_sensor;
    compensated[i] = scan.doppler()[i] - ego.bias_mps + scan.directions()[i].dot(velocity);
  }
  return compensated;
}

std::vector<std::uint8_t> dynamic_mask(const Scan& scan, const std::vector<double>& compensated,
                                       const VelocityFilterConfig& config) {
  std::vector<std::uint8_t> mask(scan.size(), 0);
  if (config.enabled) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const double tau = config.tau_0_mps + config.kappa_per_s * scan.points()[i].norm();
      mask[i] = std::abs(compensated[i]) > tau ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace dynamic_icp::ego_motion
