// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/track.hpp"

namespace dynamic_icp::tracking {

/// A track of a car around `centre` (m, world) that drives with `velocity` (m/s), from its rear and right side.
inline Track track_of_car(const Eigen::Vector3d& centre, const Eigen::Vector3d& velocity) {
  const Eigen::Matrix3d axes = upright_axes(std::atan2(velocity.y(), velocity.x()));
  Detection detection;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const RandomSource one = RandomSource(4).fork(i);
    Eigen::Vector3d q(one.uniform(0, -0.5, 0.5), one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = -0.5;
    detection.points.emplace_back(centre + axes * q.cwiseProduct(Eigen::Vector3d(4.5, 1.8, 1.5)));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(detection.directions.back().dot(velocity));
    detection.times.push_back(0.0);
  }
  return {detection, 0.0, {}};
}

}  // namespace dynamic_icp::tracking
