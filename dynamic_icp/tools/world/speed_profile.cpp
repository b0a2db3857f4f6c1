// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace dynamic_icp::world {
namespace {

using std::numbers::pi;

/// Index of the last knot at or before the time; 0 when there is none.
std::size_t knot_before(const std::vector<SpeedKnot>& knots, double time_s) {
  const auto next = std::upper_bound(knots.begin(), knots.end(), time_s,
                                     [](double time, const SpeedKnot& knot) { return time < knot.time_s; });
  return next == knots.begin() ? 0 : static_cast<std::size_t>(next - knots.begin()) - 1;
}

/// The way from knot `a` until `elapsed_s` later, on the half wave to knot `b`.
double half_wave_distance(const SpeedKnot& a, const SpeedKnot& b, double elapsed_s) {
  const double span = b.time_s - a.time_s;
  const double x = elapsed_s / span;
  return span * (a.speed_mps * x + (b.speed_mps - a.speed_mps) * (0.5 * x - std::sin(pi * x) / (2.0 * pi)));
}

}  // namespace

SpeedProfile::SpeedProfile(std::vector<SpeedKnot> knots) : knots_(std::move(knots)), distances_(knots_.size(), 0.0) {
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    distances_[i] =
        distances_[i - 1] + half_wave_distance(knots_[i - 1], knots_[i], knots_[i].time_s - knots_[i - 1].time_s);
  }
}

double SpeedProfile::speed_mps(double time_s) const {
  const std::size_t i = knot_before(knots_, time_s);
  const SpeedKnot& a = knots_[i];
  if (time_s <= a.time_s || i + 1 == knots_.size()) {
    return a.speed_mps;
  }
  const SpeedKnot& b = knots_[i + 1];
  const double x = (time_s - a.time_s) / (b.time_s - a.time_s);
  return a.speed_mps + (b.speed_mps - a.speed_mps) * 0.5 * (1.0 - std::cos(pi * x));
}

double SpeedProfile::distance_m(double time_s) const {
  return distance_since_first_knot(time_s) - distance_since_first_knot(0.0);
}

double SpeedProfile::distance_since_first_knot(double time_s) const {
  const std::size_t i = knot_before(knots_, time_s);
  const SpeedKnot& a = knots_[i];
  const double elapsed = time_s - a.time_s;
  if (elapsed <= 0.0 || i + 1 == knots_.size()) {
    return distances_[i] + elapsed * a.speed_mps;
  }
  return distances_[i] + half_wave_distance(a, knots_[i + 1], elapsed);
}

SpeedProfile wandering_speed(double mean_mps, double share, double duration_s, const RandomSource& random) {
  constexpr double kKnotSpacing_s = 2.5;  // s
  std::vector<SpeedKnot> knots;
  for (int i = 0; i * kKnotSpacing_s <= duration_s + kKnotSpacing_s; ++i) {
    const double wander = random.uniform(static_cast<std::uint64_t>(i), -share, share);
    knots.push_back({i * kKnotSpacing_s, mean_mps * (1.0 + wander)});
  }
  return SpeedProfile(std::move(knots));
}

}  // namespace dynamic_icp::world
