// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/foliage.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "dynamic_icp/tools/world/sine_wave.hpp"

namespace dynamic_icp::world {
namespace {

struct Gust {
  double frequency_hz = 0.0;
  Eigen::Vector3d axis;         // unit length: leaves move along it
  Eigen::Vector3d wave_number;  // rad/m
};

const std::array<Gust, 3>& gusts() {
  static const std::array<Gust, 3> gusts = {
      {{0.5, Eigen::Vector3d(1.0, 0.4, 0.0).normalized(), Eigen::Vector3d(1.0, 0.5, 0.6)},
       {1.1, Eigen::Vector3d(-0.3, 1.0, 0.2).normalized(), Eigen::Vector3d(-0.9, 2.1, 1.3)},
       {2.3, Eigen::Vector3d(0.5, -0.4, 1.0).normalized(), Eigen::Vector3d(3.1, -2.7, 4.2)}}};
  return gusts;
}

}  // namespace

LeafMotion leaf_motion(const Eigen::Vector3d& position, double time_s, double amplitude_m) {
  LeafMotion motion;
  for (const Gust& gust : gusts()) {
    const SineWave wave{amplitude_m / std::sqrt(static_cast<double>(gusts().size())),
                        2.0 * std::numbers::pi * gust.frequency_hz, gust.wave_number.dot(position)};
    motion.displacement += wave.value(time_s) * gust.axis;
    motion.velocity += wave.rate(time_s) * gust.axis;
  }
  return motion;
}

}  // namespace dynamic_icp::world
