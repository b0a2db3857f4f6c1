// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kShareLeft = 0.25;

bool expects_compensated(const Evidence& evidence) {
  return evidence.dataset->doppler_kind() == DopplerKind::kCompensated;
}

Finding relative(const Evidence& evidence, double speed) {
  Finding finding{Question::kDopplerKind, Verdict::kOk, ""};
  finding.sentence =
      fmt::format("relative, not ego-motion compensated; ego speed {:.1f} m/s (median of the scans sampled)", speed);
  if (expects_compensated(evidence)) {
    finding.verdict = Verdict::kWrong;
    finding.sentence += ", but the Doppler was declared compensated";
    finding.fix.doppler_kind = DopplerKind::kRelative;
  }
  return finding;
}

Finding compensated(const Evidence& evidence, const Comparison& reference) {
  Finding finding{Question::kDopplerKind, Verdict::kOk, ""};
  finding.sentence = fmt::format("compensated: the static scene is at rest while the sensor moves at {:.1f} m/s {}",
                                 reference.reference_speed_mps, reference_name(evidence, reference));
  if (!expects_compensated(evidence)) {
    finding.verdict = Verdict::kWrong;
    finding.sentence += "; the Doppler is already ego-motion compensated";
    finding.fix.doppler_kind = DopplerKind::kCompensated;
  }
  return finding;
}

/// Where nothing is measured nothing moves by it: as good as compensated, as long as no point is asked.
Finding without_doppler(const Evidence& evidence, const NoDoppler& none) {
  Finding finding{Question::kDopplerKind, Verdict::kWrong, "there is no Doppler: " + none.sentence};
  if (none.may_be_static) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = none.sentence + ": the sensor is stationary, or there is no Doppler";
  } else if (expects_compensated(evidence) && none.is_zero) {
    finding.verdict = Verdict::kSuspicious;
  } else if (none.is_zero) {
    finding.fix.doppler_kind = DopplerKind::kCompensated;
  }
  finding.evidence = none.evidence;
  return finding;
}

}  // namespace

Finding doppler_kind(const Evidence& evidence) {
  const double speed = evidence.doppler_speed_mps().value_or(0.0);
  const Comparison* reference = evidence.reference();
  Finding finding{Question::kDopplerKind, Verdict::kCannotTell, ""};
  if (const std::optional<NoDoppler> none = no_doppler(evidence)) {
    return without_doppler(evidence, *none);
  }
  if (speed > kMoves_mps) {
    finding = relative(evidence, speed);
  } else if (reference != nullptr && speed < kStandsStill_mps && speed < kShareLeft * reference->reference_speed_mps) {
    finding = compensated(evidence, *reference);
  } else {
    finding.sentence = fmt::format(
        "{} is assumed: {}", expects_compensated(evidence) ? "compensated" : "relative",
        reference == nullptr ? why_unknown(evidence)
                             : fmt::format("the static scene moves by {:.1f} m/s, the sensor at {:.1f} m/s {}", speed,
                                           reference->reference_speed_mps, reference_name(evidence, *reference)));
  }
  finding.evidence = {{"doppler_speed_mps", speed}};
  if (reference != nullptr) {
    finding.evidence.emplace_back("reference_speed_mps", reference->reference_speed_mps);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
