// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "testing/synthetic_street.hpp"

// Several sensors that move together through a synthetic scene.
namespace dynamic_icp::odometry::synthetic {

using Mountings = std::vector<Eigen::Isometry3d>;  ///< T_scan_sensor

inline Eigen::Isometry3d mounted_at(double x, double y, double yaw) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Vector3d(x, y, 0.3);
  T.linear() = exp_so3(yaw * Vector3d::UnitZ());
  return T;
}

/// Two LiDARs ahead of the origin that is followed, and two more that look back and aside.
inline const Mountings kFrontPair = {mounted_at(1.5, 0.3, 0.2), mounted_at(1.5, -0.3, -0.2)};
inline const Mountings kAround = {mounted_at(1.5, 0.0, 0.0), mounted_at(0.7, -0.8, -1.55), mounted_at(0.7, 0.8, 1.55),
                                  mounted_at(-1.2, 0.0, 3.1)};

/// The points of all sensors in the frame of the origin, which follows the path, each with the Doppler of its own
/// sensor. `bias_mps`: of each sensor, or empty.
inline RawScan rig_scan(const World& world, const Path& path, Sensor sensor, const Mountings& mountings,
                        const std::vector<double>& bias_mps, double time_s, std::uint64_t seed = 0) {
  RawScan raw;
  raw.mountings = mountings;
  for (std::size_t s = 0; s < mountings.size(); ++s) {
    sensor.bias_mps = bias_mps.empty() ? 0.0 : bias_mps[s];
    const Path path_sensor = [&](double t) { return Eigen::Isometry3d(path(t) * mountings[s]); };
    const RawScan part = scan_at(world, path_sensor, sensor, time_s, seed + s).raw;
    raw.stamp = part.stamp;
    for (const Vector3d& point : part.points) {
      raw.points.push_back(mountings[s] * point);
    }
    raw.doppler.insert(raw.doppler.end(), part.doppler.begin(), part.doppler.end());
    raw.times.insert(raw.times.end(), part.times.begin(), part.times.end());
    raw.channels.sensor.resize(raw.points.size(), static_cast<std::uint8_t>(s));
  }
  return raw;
}

/// The same measurements put together by other mountings than those by which they were made.
inline void remount(RawScan& raw, const Mountings& stated) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const std::uint8_t s = raw.channels.sensor[i];
    raw.points[i] = stated[s] * (raw.mountings[s].inverse() * raw.points[i]);
  }
  raw.mountings = stated;
}

}  // namespace dynamic_icp::odometry::synthetic
