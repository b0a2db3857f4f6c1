// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/spring_sway.hpp"

#include <numbers>

#include "dynamic_icp/tools/world/sine_wave.hpp"

namespace dynamic_icp::world {

using std::numbers::pi;

SwayFunction spring_sway(double scale, const RandomSource& random) {
  const auto wave = [&](std::uint64_t stream, double amplitude, double low_hz, double high_hz) {
    return SineWave{scale * amplitude, 2.0 * pi * random.uniform(2 * stream, low_hz, high_hz),
                    random.uniform(2 * stream + 1, 0.0, 2.0 * pi)};
  };
  constexpr double kDegree = pi / 180.0;
  const SineWave heave = wave(0, 0.012, 0.9, 1.4);
  const SineWave pitch = wave(1, 0.4 * kDegree, 0.6, 1.1);
  const SineWave roll = wave(2, 0.4 * kDegree, 0.4, 0.8);
  return [heave, pitch, roll](double t, const PlanarState&) {
    return Sway{heave.value(t), pitch.value(t), roll.value(t), heave.rate(t), pitch.rate(t), roll.rate(t)};
  };
}

}  // namespace dynamic_icp::world
