// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace dynamic_icp::world {

/// amplitude * sin(omega t + phase), with its time derivative.
struct SineWave {
  double amplitude = 0.0;
  double omega = 0.0;  ///< rad/s
  double phase = 0.0;  ///< rad

  [[nodiscard]] double value(double t) const { return amplitude * std::sin(omega * t + phase); }
  [[nodiscard]] double rate(double t) const { return amplitude * omega * std::cos(omega * t + phase); }
};

}  // namespace dynamic_icp::world
