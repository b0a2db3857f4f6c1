// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/simulation/ray_returns.hpp"

namespace dynamic_icp::simulation {

// Returns of what is no surface there. They belong to no body and are given as shares that are seen.

/// A rain drop at this range: it falls at 6 m/s and drifts by about 1 m/s any way.
Return rain_drop(const Moment& moment, const Eigen::Vector3d& direction_sensor, double range,
                 const RandomSource& random);

/// Spray behind the wheels of moving bodies: of the rays that cross a cloud, `rate` meet a drop in it, anywhere on
/// their way through. The cloud of a body faster than 5 m/s is a box of its width, 1.5 m high, that reaches 8 m behind
/// it; a drop follows the body with 60 % of its velocity, e^(-1) of that 5 m behind it, and drifts by 0.5 m/s any way.
std::optional<Return> spray_drop(const Moment& moment, const world::World& world,
                                 const Eigen::Vector3d& direction_sensor, double free_range_m, double rate,
                                 const RandomSource& random);

/// The window before the sensor: 0.1 to 0.5 m away, at rest in the sensor frame.
Return window_return(const RandomSource& random);

/// The image of a surface in another that acts as a mirror: behind the mirror, along the first ray, as far as the light
/// went. `mirror` and `seen` are the surfaces in the order the light meets them, `velocity_`: m/s of their points.
struct MirrorImage {
  Eigen::Vector3d direction_world;  ///< of the first ray
  Eigen::Vector3d mirror_normal;
  Eigen::Vector3d mirror_velocity;
  double mirror_range_m = 0.0;
  Eigen::Vector3d seen_velocity;
  Echo seen;  ///< its range from the mirror
};
Return ghost(const Moment& moment, const MirrorImage& image);

}  // namespace dynamic_icp::simulation
