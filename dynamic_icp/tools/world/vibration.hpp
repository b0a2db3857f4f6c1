// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/motion_state.hpp"

namespace dynamic_icp::world {

/// Vibration in a band of frequencies. Each of the six axes (forward, left, up; roll, pitch, yaw) is a sum of three
/// sines with random frequencies in the band and random phases, of the power of one sine of this amplitude.
struct VibrationBand {
  double low_hz = 0.0;
  double high_hz = 0.0;
  double amplitude_mm = 0.0;
  double amplitude_deg = 0.0;
};

/// How a vehicle's body shakes, besides the slow motion on its springs that the scenes have. Off unless an amplitude is
/// given; the bands are those of road vehicles.
struct VibrationConfig {
  VibrationBand body{1.0, 2.0};    ///< the body on its springs
  VibrationBand wheel{8.0, 15.0};  ///< wheel hop
  VibrationBand engine{20.0, 30.0};
  double bump_s = 0.0;    ///< when a wheel meets a kerb or a pothole
  double bump_mm = 0.0;   ///< how far up that throws the body
  double bump_deg = 0.0;  ///< how far it pitches
};

ConfigFields fields(VibrationConfig& config);

/// Throws UsageError when a value is out of range or a band ends below its begin.
void check(VibrationConfig config);

/// The trajectory of a body that shakes about a point of itself, with the exact twist:
///   T_world_body(t) * T_body_pivot * V(t) * T_body_pivot^-1,   V = (x, y, z) Rz(yaw) Ry(pitch) Rx(roll).
/// The bump is exp(-t/T) (1 - exp(-t/T)) sin(2 pi 10 Hz t) from `bump_s` on, T = 0.03 s, scaled to a largest value
/// of 1. The trajectory itself where no amplitude is given.
Trajectory vibrating(Trajectory body, const Eigen::Isometry3d& T_body_pivot, const VibrationConfig& config,
                     const RandomSource& random);

}  // namespace dynamic_icp::world
