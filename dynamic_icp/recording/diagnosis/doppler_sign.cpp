// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kAlong_deg = 60.0;
constexpr std::size_t kManyMotions = 3;
constexpr double kOppositeLength = 0.3;

/// Whether the Doppler is opposite beyond doubt: most of what is seen in a jam moves, this way or that. What few
/// motions scatter by is not known, so they must be opposite in length, too.
bool is_opposite(const Comparison& reference) {
  return reference.turned_deg > 180.0 - kAlong_deg && reference.ratio + kCertain * reference.ratio_error < 0.0 &&
         (reference.moving >= kManyMotions || std::abs(reference.ratio + 1.0) < kOppositeLength);
}

/// The mean velocity of all looks, in the axes of the sensor.
Eigen::Vector3d mean_velocity(const Evidence& evidence) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ScanLook& look : evidence.looks) {
    sum += look.has_velocity() ? look.ego.velocity_sensor : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  return sum;
}

Finding without_reference(const Evidence& evidence) {
  Finding finding{Question::kDopplerSign, Verdict::kCannotTell, ""};
  const double speed = evidence.doppler_speed_mps().value_or(0.0);
  finding.evidence = {{"doppler_speed_mps", speed}};
  if (speed < kMoves_mps) {
    finding.sentence = fmt::format("positive away from the sensor is assumed: {}", why_unknown(evidence));
  } else if (mean_velocity(evidence).x() > 0.0) {
    finding.sentence =
        fmt::format("positive away from the sensor is assumed: {}; so it is if the sensor looks where it drives",
                    why_unknown(evidence));
  } else {
    finding.sentence = fmt::format(
        "positive away from the sensor is assumed: {}; positive means towards if the sensor looks where it drives",
        why_unknown(evidence));
  }
  return finding;
}

}  // namespace

Finding doppler_sign(const Evidence& evidence) {
  const Comparison* reference = evidence.reference();
  if (reference == nullptr) {
    return without_reference(evidence);
  }
  if (reference->doppler_speed_mps < kMoves_mps) {
    return {
        Question::kDopplerSign,
        Verdict::kCannotTell,
        fmt::format("positive away from the sensor is assumed: the Doppler shows {:.1f} m/s where the sensor moves at "
                    "{:.1f} m/s {}",
                    reference->doppler_speed_mps, reference->reference_speed_mps, reference_name(evidence, *reference)),
        {},
        false,
        comparison_numbers(*reference)};
  }
  Finding finding{Question::kDopplerSign, Verdict::kOk, ""};
  finding.evidence = comparison_numbers(*reference);
  const std::string source = reference_name(evidence, *reference);
  if (reference->turned_deg < kAlong_deg && reference->ratio > 0.0) {
    finding.sentence =
        fmt::format("positive away from the sensor: the ego velocity from Doppler agrees with that {}", source);
  } else if (is_opposite(*reference)) {
    finding.verdict = Verdict::kWrong;
    finding.sentence =
        fmt::format("positive TOWARDS the sensor: the ego velocity from Doppler, {:.1f} m/s, is opposite to that {}",
                    reference->doppler_speed_mps, source);
    if (reference == &evidence.truth) {
      finding.sentence +=
          "; or points and Doppler are right and the sensor is turned by 180 degrees against that of the ground truth: "
          "no scans could be matched to decide";
    }
    finding.fix.doppler_sign = evidence.applied.doppler_sign == datasets::DopplerSign::kTowards
                                   ? datasets::DopplerSign::kAway
                                   : datasets::DopplerSign::kTowards;
  } else {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = fmt::format(
        "positive away from the sensor is assumed: the ego velocity from Doppler is {:.0f} degrees off that {}",
        reference->turned_deg, source);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
