// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "dynamic_icp/base/random_source.hpp"
#include "dynamic_icp/base/scan.hpp"
#include "dynamic_icp/base/se3.hpp"
#include "dynamic_icp/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

// A world for tests: boxes that move on level ground before a distant wall, seen by a sensor at rest in the origin,
// 1.5 m above the ground. Every point is where a ray meets a surface; every Doppler is that of the material point.

/// A box and its motion at one time.
struct MovingBox {
  OrientedBox box;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of its centre
  double yaw_rate = 0.0;                               ///< rad/s
};

/// A car whose centre is at (x, y), driving with `speed` in the direction of `yaw`.
inline MovingBox car(double x, double y, double yaw, double speed, double yaw_rate = 0.0) {
  const Eigen::Matrix3d axes = upright_axes(yaw);
  return {{{x, y, -0.75}, axes, {4.4, 1.8, 1.5}}, speed * axes.col(0), yaw_rate};
}

struct View {
  Scan scan;
  std::vector<double> radial;
  std::vector<std::uint8_t> is_moving;
  std::vector<std::int32_t> body;  ///< index of the box, -1 for ground and wall
};

/// Distance along the ray from the origin to the box, infinite when it misses.
inline double hit(const OrientedBox& box, const Eigen::Vector3d& u) {
  const Eigen::Array3d origin = -box.axes.transpose() * box.centre;
  const Eigen::Array3d slope = (box.axes.transpose() * u).array();
  const Eigen::Array3d a = (-0.5 * box.size.array() - origin) / slope;
  const Eigen::Array3d b = (0.5 * box.size.array() - origin) / slope;
  const double enter = a.min(b).maxCoeff();
  const double leave = a.max(b).minCoeff();
  return enter > 0.0 && enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

/// What the sensor sees at `time_s`: rays 0.25 degrees apart sideways and 0.5 up and down, 2 cm and 5 cm/s of noise,
/// and a share of gross Doppler errors.
inline View view_of(const std::vector<MovingBox>& boxes, double time_s, double outliers = 0.005) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  View view;
  RawScan raw;
  raw.stamp = {static_cast<std::int64_t>(std::llround(1e9 * time_s))};
  const RandomSource random = RandomSource(31).fork(static_cast<std::uint64_t>(raw.stamp.ns));
  std::uint64_t ray = 0;
  for (double azimuth = -60.0; azimuth <= 60.0; azimuth += 0.25) {
    for (double elevation = -12.0; elevation <= 4.0; elevation += 0.5) {
      const RandomSource one = random.fork(++ray);
      const double c = std::cos(elevation * kDegree);
      const Eigen::Vector3d u(c * std::cos(azimuth * kDegree), c * std::sin(azimuth * kDegree),
                              std::sin(elevation * kDegree));
      double range = std::min(100.0, u.z() < 0.0 ? -1.5 / u.z() : 100.0);
      std::int32_t body = -1;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const double distance = hit(boxes[i].box, u);
        if (distance < range) {
          range = distance;
          body = static_cast<std::int32_t>(i);
        }
      }
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      if (body >= 0) {
        const MovingBox& box = boxes[static_cast<std::size_t>(body)];
        velocity = box.velocity + box.yaw_rate * Eigen::Vector3d::UnitZ().cross(range * u - box.box.centre);
      }
      const bool gross = one.uniform(0) < outliers;
      raw.points.emplace_back((range + 0.02 * one.normal(1)) * u);
      raw.doppler.push_back(gross ? one.uniform(2, -30.0, 30.0) : u.dot(velocity) + 0.05 * one.normal(3));
      view.body.push_back(body);
    }
  }
  view.scan = Scan::from_raw(raw);
  view.radial = view.scan.doppler();
  for (const double radial : view.radial) {
    view.is_moving.push_back(std::abs(radial) > 0.3 ? 1 : 0);
  }
  return view;
}

}  // namespace dynamic_icp::tracking
