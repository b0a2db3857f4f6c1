// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::world {

/// The speed of a vehicle at one time of the scene.
struct SpeedKnot {
  double time_s = 0.0;
  double speed_mps = 0.0;
};

/// Speed over time through the given knots, in half waves of a cosine: smooth, without overshoot, at rest between two
/// knots of speed zero, and with the distance in closed form. Constant before the first and after the last knot.
class SpeedProfile {
 public:
  /// Constant speed.
  explicit SpeedProfile(double speed_mps) : SpeedProfile(std::vector<SpeedKnot>{{0.0, speed_mps}}) {}

  /// At least one knot; times must increase.
  explicit SpeedProfile(std::vector<SpeedKnot> knots);

  [[nodiscard]] double speed_mps(double time_s) const;

  /// The way driven since time 0 (m), the integral of the speed; negative before.
  [[nodiscard]] double distance_m(double time_s) const;

 private:
  [[nodiscard]] double distance_since_first_knot(double time_s) const;

  std::vector<SpeedKnot> knots_;
  std::vector<double> distances_;  // m, from the first knot to each knot
};

/// Speed that wanders smoothly within `share` of its mean for the duration.
SpeedProfile wandering_speed(double mean_mps, double share, double duration_s, const RandomSource& random);

}  // namespace dynamic_icp::world
