// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/recording_check.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

namespace dynamic_icp::runs {
namespace {

// Spread over the run, as a sensor may be at rest when it begins; few, so that the check takes the same time however
// long the run is.
constexpr std::size_t kProbes = 4;

}  // namespace

RecordingCheck check_recording(const datasets::Dataset& dataset, const datasets::InputSettings& settings,
                               const ScansToCheck& scans, const Needs& needs, const FixInWords& fix_in_words) {
  const auto fix_of = [&](const diagnosis::Finding& finding) { return fix_in_words ? fix_in_words(finding) : ""; };
  diagnosis::DiagnosisConfig config;
  config.begin = scans.begin;
  config.end = scans.end;
  config.probes = kProbes;
  config.applied = settings.correction;
  config.always_match_scans = false;
  config.search_sweep = false;
  const Workers workers(scans.threads);
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(dataset, config, workers);
  RecordingCheck check;
  check.period_s = diagnosis.period_s;
  check.doppler = fmt::format("{}; {}", diagnosis.of(diagnosis::Question::kDopplerKind).sentence,
                              diagnosis.of(diagnosis::Question::kDopplerSign).sentence);
  if (!diagnosis.has_doppler && needs.doppler && !settings.correction.doppler_kind) {
    const auto with_kind = [&](DopplerKind kind) {
      diagnosis::Finding finding;
      finding.fix.doppler_kind = kind;
      return fix_in_words ? fmt::format(" ({})", fix_of(finding)) : "";
    };
    throw DataError(fmt::format(
        "{}: {}. Take a method that needs none, such as kiss-icp; or state the kind of Doppler: compensated, to go by "
        "the shape of the scene alone{}, or relative, if it is Doppler all the same{}",
        dataset.scan_file(scans.begin).string(), diagnosis.of(diagnosis::Question::kDopplerKind).sentence,
        with_kind(DopplerKind::kCompensated), with_kind(DopplerKind::kRelative)));
  }
  for (const diagnosis::Finding& finding : diagnosis.findings) {
    const bool is_sign = finding.question == diagnosis::Question::kDopplerSign;
    const bool is_kind = finding.question == diagnosis::Question::kDopplerKind;
    const bool is_stated = (is_sign && settings.correction.doppler_sign) ||
                           (is_kind && (settings.correction.doppler_kind || !diagnosis.has_doppler));
    if (finding.verdict == diagnosis::Verdict::kWrong && (is_sign || is_kind) && !is_stated) {
      diagnosis::Finding as_it_is;
      as_it_is.fix = is_sign ? datasets::Correction{.doppler_sign = datasets::DopplerSign::kAway}
                             : datasets::Correction{.doppler_kind = dataset.doppler_kind()};
      const std::string hint = fix_in_words ? fmt::format(". Run with {}; or state that it is not so with {}",
                                                          fix_of(finding), fix_of(as_it_is))
                                            : "";
      throw DataError(
          fmt::format("{}: the Doppler is {}{}", dataset.scan_file(scans.begin).string(), finding.sentence, hint));
    }
    if (finding.verdict == diagnosis::Verdict::kWrong || finding.verdict == diagnosis::Verdict::kSuspicious) {
      const std::string fix = fix_of(finding);
      check.warnings.push_back(fmt::format("{}: {}{}", diagnosis::to_string(finding.question), finding.sentence,
                                           fix.empty() ? "" : "; fix with " + fix));
    }
  }
  if (needs.sweep) {
    check.sweep = diagnosis::search_sweep(dataset, {scans.begin, scans.end}, check.period_s, workers);
  }
  return check;
}

}  // namespace dynamic_icp::runs
