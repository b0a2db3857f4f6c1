// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::simulation {

/// Angles that a sensor sees.
struct AngularSpan {
  double horizontal_rad = 0.0;
  double vertical_rad = 0.0;
  double vertical_center_rad = 0.0;
};

/// A random number for each direction that changes smoothly with azimuth a and elevation e:
///   f(a, e) = sum over m = 0..3, n = -1..1 of c_mn cos(2 pi (m a + n e) / A + phi_mn) - mean,
/// with random amplitudes that fall with m and random phases. A is twice the horizontal view, or the full circle where
/// that is the view, so that the field closes. Over the view its mean is 0 and its root mean square `rms`.
class DirectionField {
 public:
  DirectionField(double rms, const AngularSpan& span, const RandomSource& random);

  [[nodiscard]] double at(double azimuth_rad, double elevation_rad) const;

 private:
  struct Harmonic {
    double per_azimuth = 0.0;    // rad/rad
    double per_elevation = 0.0;  // rad/rad
    double phase = 0.0;
    double amplitude = 0.0;
  };

  double mean_ = 0.0;
  std::vector<Harmonic> harmonics_;  // none where the field is 0
};

}  // namespace dynamic_icp::simulation
