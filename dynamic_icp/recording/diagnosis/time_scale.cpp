// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {

namespace {

/// How much farther the ground truth moves than points and Doppler, which agree; nothing where it does not.
std::optional<double> truth_alone_differs(const Evidence& evidence) {
  const Comparison& truth = evidence.truth;
  const Comparison& matching = evidence.matching;
  if (!truth.tells() || !matching.tells() || evidence.units.points != 1.0 || evidence.units.doppler != 1.0 ||
      !matching.is_same() || !truth.is_other()) {
    return std::nullopt;
  }
  return 1.0 / truth.ratio;
}

}  // namespace

Finding time_scale(const Evidence& evidence) {
  Finding finding{Question::kTimeScale, Verdict::kOk, ""};
  const std::optional<SpeedRatio> speed = speed_ratio(evidence);
  if (!speed) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = fmt::format(
        "the stamps are taken as they are: {}",
        evidence.reference() == nullptr ? why_unknown(evidence) : "the Doppler shows no motion of the sensor");
    return finding;
  }
  finding.evidence = comparison_numbers(*speed->reference);
  const std::string source = reference_name(evidence, *speed->reference);
  const double ratio = speed->ratio / speed->unit_factor;
  if (const std::optional<double> farther = truth_alone_differs(evidence)) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "points and Doppler agree, but the ground truth moves {:.2f} times as far: it is of another drive, unit or "
        "time",
        *farther);
  } else if (speed->is_one || !speed->unit.empty()) {
    finding.sentence = fmt::format("the Doppler gives {:.3f} times the speed {}", ratio, source);
  } else {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format(
        "the Doppler gives {:.2f} times the speed {} (+- {:.2f}): the stamps run {:.2f} times as fast as time, or a "
        "unit is not what it seems",
        ratio, source, speed->reference->ratio_error, ratio);
    finding.fix.time_scale = rounded(evidence.applied.time_scale.value_or(1.0) / ratio, 4);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
