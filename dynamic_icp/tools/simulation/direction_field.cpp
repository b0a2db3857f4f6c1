// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/direction_field.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp::simulation {

using std::numbers::pi;

DirectionField::DirectionField(double rms, const AngularSpan& span, const RandomSource& random) {
  if (rms == 0.0) {
    return;
  }
  const bool closed = span.horizontal_rad > 2.0 * pi - 1e-9;
  const double period = closed ? span.horizontal_rad : 2.0 * span.horizontal_rad;
  std::uint64_t stream = 0;
  for (int m = 0; m <= 3; ++m) {
    for (int n = m == 0 ? 1 : -1; n <= 1; ++n, stream += 2) {
      harmonics_.push_back({2.0 * pi * m / period, 2.0 * pi * n / period, random.uniform(stream, 0.0, 2.0 * pi),
                            random.normal(stream + 1) / (1.0 + m)});
    }
  }
  constexpr int kColumns = 180;
  constexpr int kRows = 24;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const double across = (i % kColumns + 0.5) / kColumns - 0.5;
    const double up = (i / kColumns + 0.5) / kRows - 0.5;
    const double value = at(across * span.horizontal_rad, span.vertical_center_rad + up * span.vertical_rad);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / (kColumns * kRows);
  const double scale = rms / std::sqrt(squares / (kColumns * kRows) - mean * mean);
  mean_ = scale * mean;
  for (Harmonic& harmonic : harmonics_) {
    harmonic.amplitude *= scale;
  }
}

double DirectionField::at(double azimuth_rad, double elevation_rad) const {
  double value = -mean_;
  for (const Harmonic& harmonic : harmonics_) {
    value += harmonic.amplitude *
             std::cos(harmonic.per_azimuth * azimuth_rad + harmonic.per_elevation * elevation_rad + harmonic.phase);
  }
  return value;
}

}  // namespace dynamic_icp::simulation
