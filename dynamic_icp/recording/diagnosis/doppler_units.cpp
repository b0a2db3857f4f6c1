// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {

Finding doppler_units(const Evidence& evidence) {
  Finding finding{Question::kDopplerUnits, Verdict::kOk, ""};
  const double as_stored = evidence.median_of(&ScanLook::fast_mps) / evidence.units.doppler;
  finding.evidence = {{"doppler_95_percent", as_stored}};
  const std::optional<SpeedRatio> speed = speed_ratio(evidence);
  if (speed) {
    finding.evidence.emplace_back("ratio", speed->ratio);
  }
  if (const std::optional<NoDoppler> none = no_doppler(evidence); none && !none->is_zero) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = "the last column is no Doppler";
  } else if (evidence.looks.empty() || as_stored == 0.0) {
    finding.verdict = evidence.looks.empty() ? Verdict::kCannotTell : Verdict::kSuspicious;
    finding.sentence = evidence.looks.empty() ? "there are no scans" : "nearly all Doppler values are zero";
  } else if (speed && !speed->unit.empty()) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format("the Doppler is {:.4g} times the speed {}: it is in {}", speed->ratio,
                                   reference_name(evidence, *speed->reference), speed->unit);
    finding.fix.doppler_scale = rounded(evidence.applied.doppler_scale.value_or(1.0) / speed->unit_factor, 6);
  } else if (evidence.units.doppler != 1.0) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format("Doppler of {:.0f} cannot be m/s", as_stored);
    finding.fix.doppler_scale = rounded(evidence.applied.doppler_scale.value_or(1.0) * evidence.units.doppler, 6);
  } else if (!speed) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = fmt::format("m/s are assumed: 95 % of the points are slower than {:.1f}", as_stored);
  } else {
    finding.sentence = fmt::format("m/s: 95 % of the points are slower than {:.1f} m/s", as_stored);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
