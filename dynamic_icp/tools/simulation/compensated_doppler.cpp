// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/compensated_doppler.hpp"

namespace dynamic_icp::simulation {

std::vector<double> compensated_doppler(const RawScan& scan, const Simulation& simulation, std::size_t sensor) {
  std::vector<double> doppler(scan.doppler.size());
  const double begin_s = seconds_between(Stamp{}, scan.stamp);
  double offset_s = -1.0;
  Eigen::Vector3d velocity_sensor = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < doppler.size(); ++i) {
    if (i == 0 || scan.times[i] != offset_s) {  // many points have the same time, one after the other
      offset_s = scan.times[i];
      velocity_sensor = simulation.sensor_state(begin_s + offset_s, sensor).velocity_sensor;
    }
    doppler[i] = scan.doppler[i] + scan.points[i].normalized().dot(velocity_sensor);
  }
  return doppler;
}

}  // namespace dynamic_icp::simulation
