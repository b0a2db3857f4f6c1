// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/recording_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

namespace dynamic_icp::runs {
namespace {

// Some seconds of driving are enough and keep the time that the check takes bounded, however long the recording is.
constexpr std::size_t kScans = 60;
constexpr std::size_t kProbes = 4;

}  // namespace

RecordingCheck check_recording(const datasets::Dataset& dataset, const datasets::InputSettings& settings,
                               std::size_t begin, std::size_t end, bool needs_doppler, int threads) {
  diagnosis::DoctorConfig config;
  config.begin = begin;
  config.end = std::min(end, begin + kScans);
  config.probes = kProbes;
  config.applied = settings.correction;
  config.always_match_scans = false;
  const diagnosis::Diagnosis diagnosis = diagnosis::diagnose(dataset, config, Workers(threads));
  RecordingCheck check;
  check.period_s = diagnosis.period_s;
  check.doppler = fmt::format("{}; {}", diagnosis.of(diagnosis::Question::kDopplerKind).sentence,
                              diagnosis.of(diagnosis::Question::kDopplerSign).sentence);
  if (!diagnosis.has_doppler && needs_doppler && !settings.correction.doppler_kind) {
    throw DataError(fmt::format(
        "{}: {}. A method that needs none: --method kiss-icp; by the shape of the scene alone: --doppler-kind "
        "compensated; it is Doppler all the same: --doppler-kind relative",
        dataset.scan_file(begin).string(), diagnosis.of(diagnosis::Question::kDopplerKind).sentence));
  }
  for (const diagnosis::Finding& finding : diagnosis.findings) {
    const bool is_sign = finding.question == diagnosis::Question::kDopplerSign;
    const bool is_kind = finding.question == diagnosis::Question::kDopplerKind;
    const bool is_said = (is_sign && settings.doppler_sign_is_said) ||
                         (is_kind && (settings.correction.doppler_kind || !diagnosis.has_doppler));
    if (finding.verdict == diagnosis::Verdict::kWrong && (is_sign || is_kind) && !is_said) {
      throw DataError(fmt::format(
          "{}: the Doppler is {}. Run with {}; or say that it is not so with {}", dataset.scan_file(begin).string(),
          finding.sentence, finding.fix,
          is_sign ? (settings.correction.doppler_is_towards ? "--doppler-sign towards" : "--doppler-sign away")
          : dataset.doppler_kind() == DopplerKind::kRelative ? "--doppler-kind relative"
                                                             : "--doppler-kind compensated"));
    }
    if (finding.verdict == diagnosis::Verdict::kWrong || finding.verdict == diagnosis::Verdict::kSuspicious) {
      check.warnings.push_back(fmt::format("{}: {}{}", diagnosis::to_string(finding.question), finding.sentence,
                                           finding.fix.empty() ? "" : "; mend it with " + finding.fix));
    }
  }
  return check;
}

}  // namespace dynamic_icp::runs
