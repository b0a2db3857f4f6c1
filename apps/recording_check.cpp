// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/recording_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include "apps/input_options.hpp"

namespace dynamic_icp::apps {
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
    const bool is_stated = (is_sign && settings.correction.doppler_sign) ||
                           (is_kind && (settings.correction.doppler_kind || !diagnosis.has_doppler));
    if (finding.verdict == diagnosis::Verdict::kWrong && (is_sign || is_kind) && !is_stated) {
      const datasets::Correction as_it_is = is_sign ? datasets::Correction{.doppler_sign = datasets::DopplerSign::kAway}
                                                    : datasets::Correction{.doppler_kind = dataset.doppler_kind()};
      throw DataError(fmt::format("{}: the Doppler is {}. Run with {}; or say that it is not so with {}",
                                  dataset.scan_file(begin).string(), finding.sentence, fixing_options(finding),
                                  as_options(as_it_is)));
    }
    if (finding.verdict == diagnosis::Verdict::kWrong || finding.verdict == diagnosis::Verdict::kSuspicious) {
      const std::string fix = fixing_options(finding);
      check.warnings.push_back(fmt::format("{}: {}{}", diagnosis::to_string(finding.question), finding.sentence,
                                           fix.empty() ? "" : "; fix with " + fix));
    }
  }
  return check;
}

}  // namespace dynamic_icp::apps
