// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kNearPower = 0.15;
constexpr double kFeetPerMetre = 3.28084;
constexpr double kNearFeet = 0.03;

/// How much farther the sensor moves by the points than by what knows metres: truth, else the Doppler.
std::optional<double> scale_by_motion(const Evidence& evidence) {
  const Comparison& matching = evidence.matching;
  if (!matching.tells()) {
    return std::nullopt;
  }
  if (evidence.truth.tells() && evidence.truth.reference_speed_mps > 0.0) {
    return matching.reference_speed_mps / evidence.truth.reference_speed_mps;
  }
  return matching.doppler_speed_mps > kMoves_mps ? std::optional(1.0 / std::abs(matching.ratio)) : std::nullopt;
}

/// How much farther the sensor moves by the points than by ground truth and Doppler, which agree; nothing where they do
/// not, or where the points agree as well.
std::optional<double> farther_than_both(const Evidence& evidence) {
  const Comparison& truth = evidence.truth;
  const Comparison& matching = evidence.matching;
  if (!truth.tells() || !matching.tells() || !truth.is_same() || !matching.is_other()) {
    return std::nullopt;
  }
  return 1.0 / matching.ratio;
}

}  // namespace

Finding point_units(const Evidence& evidence) {
  Finding finding{Question::kPointUnits, Verdict::kOk, ""};
  const double as_stored = evidence.median_of(&ScanLook::far_m) / evidence.units.points;
  finding.evidence = {{"distance_95_percent", as_stored}};
  if (!(as_stored > 0.0)) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = "there are no points";
    return finding;
  }
  double factor = evidence.units.points;
  const std::optional<double> scale = scale_by_motion(evidence);
  if (scale && *scale > 0.0) {
    finding.evidence.emplace_back("way_by_points_over_way", *scale / evidence.units.points);
    const double power = std::round(std::log10(*scale));
    if (power != 0.0 && std::abs(std::log10(*scale) - power) < kNearPower) {
      factor /= std::pow(10.0, power);
    }
  }
  if (const std::optional<double> farther = farther_than_both(evidence); farther && factor == 1.0) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format(
        "the points move {:.2f} times as far as ground truth and Doppler both say: these are not metres", *farther);
    finding.fix.point_scale = rounded(evidence.applied.point_scale.value_or(1.0) / *farther, 4);
  } else if (factor != 1.0) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format("95 % of the points are nearer than {:.4g}: these are not metres", as_stored);
    finding.fix.point_scale = rounded(evidence.applied.point_scale.value_or(1.0) * factor, 6);
  } else if (scale && std::abs(std::log(*scale / kFeetPerMetre)) < kNearFeet) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "the points move {:.2f} times as far as the Doppler says: they may be in feet; or scans follow each other "
        "faster than the stamps say",
        *scale);
    finding.fix.point_scale = rounded(evidence.applied.point_scale.value_or(1.0) / kFeetPerMetre, 4);
  } else {
    finding.sentence = fmt::format("m: 95 % of the points are nearer than {:.1f} m", as_stored);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
