// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/ego_motion/support_plane.hpp"

namespace dynamic_icp::tracking {

/// What a scan shows of the ground.
struct GroundFit {
  ego_motion::SupportPlane plane;  ///< sensor axes
  std::size_t points = 0;          ///< on it, of those that were looked at
};

/// The plane through the points that do not move (`is_moving`: a flag for each of the `points`, m, sensor frame) near
/// the plane `start`, which may be off by half a metre: of some planes through three points that with most points on
/// it, then least squares with Tukey's weights that narrow from step to step. Nothing where few points lie on it.
std::optional<GroundFit> fit_ground(const ego_motion::SupportPlane& start, std::span<const Eigen::Vector3d> points,
                                    std::span<const std::uint8_t> is_moving);

/// The fit of the ground, of two that the same scan shows. Of about the same plane, that with more points. Else that
/// which is nearer to the sensor, as what bounds a scene besides the ground passes below it near the carrier; but not
/// one of far fewer points.
const GroundFit& likelier_ground(const GroundFit& a, const GroundFit& b);

}  // namespace dynamic_icp::tracking
