// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/speed_ratio.hpp"

#include <cmath>

namespace dynamic_icp::diagnosis {
namespace {

// Radar and repeated poses scatter by some per cent; nobody calibrates a clock by driving.
constexpr double kUsual = 0.08;
constexpr double kDeviations = 4.0;
constexpr std::size_t kEnough = 5;
constexpr double kUnitMatch = 0.05;
constexpr double kUnitWrongBy = 0.3;
constexpr double kMoving_mps = 1.0;

struct Unit {
  std::string_view name;
  double per_mps;
};

constexpr Unit kUnits[] = {{"km/h", 3.6},    {"mm/s", 1000.0},   {"cm/s", 100.0},
                           {"mph", 2.23694}, {"knots", 1.94384}, {"ft/s", 3.28084}};

/// The one whose ratio is known better; metres that are guessed are no measure.
const Comparison* best_reference(const Evidence& evidence) {
  if (!evidence.truth.tells() || !evidence.matching.tells()) {
    return evidence.truth.tells() ? &evidence.truth : evidence.reference();
  }
  const bool points_are_better =
      evidence.units.points == 1.0 && evidence.matching.ratio_error < evidence.truth.ratio_error;
  return points_are_better && evidence.matching.moving >= kEnough ? &evidence.matching : &evidence.truth;
}

}  // namespace

std::optional<SpeedRatio> speed_ratio(const Evidence& evidence) {
  SpeedRatio result;
  result.reference = best_reference(evidence);
  // By the reference and the Doppler both, along or against each other: the size is what counts here.
  if (result.reference == nullptr || result.reference->doppler_speed_mps < kMoving_mps) {
    return std::nullopt;
  }
  const Comparison& reference = *result.reference;
  const double turned = std::cos(reference.turned_deg * 3.14159265358979 / 180.0);
  const double guessed = std::abs(turned) > 0.5
                             ? std::abs(reference.ratio)
                             : reference.doppler_speed_mps / std::max(1e-6, reference.reference_speed_mps);
  result.ratio = guessed / evidence.units.doppler;
  const double allowed = std::max(kUsual, kDeviations * reference.ratio_error);
  result.is_one = std::abs(std::log(result.ratio)) < std::log1p(allowed);
  // A few odd motions out of many, at walking pace in a jam, prove nothing.
  if (!result.is_one && 2 * reference.moving <= evidence.probes.size()) {
    return std::nullopt;
  }
  for (const Unit& unit : kUnits) {
    const double off = std::abs(std::log(result.ratio / unit.per_mps));
    if (!result.is_one && off < std::max(kUnitMatch, std::min(kUnitWrongBy, allowed))) {
      result.unit = unit.name;
      result.unit_factor = unit.per_mps;
      break;
    }
  }
  return result;
}

}  // namespace dynamic_icp::diagnosis
