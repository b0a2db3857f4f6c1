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

using datasets::Correction;
using diagnosis::Question;

/// What the numbers of a recording are taken for where nobody states anything: who states the same knows better than
/// the diagnosis. Empty where a question stops no run: of timestamps that do not fit the speeds nobody knows which of
/// both is wrong.
Correction as_it_is(Question question, const datasets::Dataset& dataset) {
  switch (question) {
    case Question::kDopplerSign:
      return {.doppler_sign = datasets::DopplerSign::kAway};
    case Question::kDopplerKind:
      return {.doppler_kind = dataset.doppler_kind()};
    case Question::kDopplerUnits:
      return {.doppler_scale = 1.0};
    case Question::kPointUnits:
      return {.point_scale = 1.0};
    case Question::kColumns:
      return {.columns = Correction::kInOrder};
    default:
      return {};
  }
}

/// Whether the user stated what the question asks.
bool is_stated(Question question, const datasets::InputSettings& settings) {
  const Correction& correction = settings.correction;
  switch (question) {
    case Question::kDopplerSign:
      return correction.doppler_sign.has_value();
    case Question::kDopplerKind:
      return correction.doppler_kind.has_value();
    case Question::kDopplerUnits:
      return correction.doppler_scale.has_value();
    case Question::kPointUnits:
      return correction.point_scale.has_value();
    case Question::kColumns:
      return correction.columns.has_value() || !settings.open.columns.empty();
    default:
      return true;
  }
}

/// Whether every result would be wrong, there is a way out, and the user has not stated that it is right.
bool stops(const diagnosis::Finding& finding, const datasets::InputSettings& stated, bool has_doppler,
           const Needs& needs) {
  if (finding.verdict != diagnosis::Verdict::kWrong || finding.fix == Correction{} ||
      is_stated(finding.question, stated)) {
    return false;
  }
  return finding.question == Question::kDopplerKind    ? has_doppler
         : finding.question == Question::kDopplerUnits ? needs.doppler
                                                       : true;
}

/// What is wrong, what fixes all of it, and how to state that it is right.
std::string refusal(const std::vector<const diagnosis::Finding*>& findings, const datasets::Dataset& dataset,
                    const FixInWords& fix_in_words) {
  std::string text;
  diagnosis::Finding fixes;
  diagnosis::Finding is_right;
  for (const diagnosis::Finding* finding : findings) {
    const bool is_of_doppler =
        finding->question == Question::kDopplerSign || finding->question == Question::kDopplerKind;
    text +=
        fmt::format("{}{}{}", text.empty() ? "" : "; and ", is_of_doppler ? "the Doppler is " : "", finding->sentence);
    fixes.fix.apply(finding->fix);
    is_right.fix.apply(as_it_is(finding->question, dataset));
  }
  if (!fix_in_words) {
    return text;
  }
  return fmt::format("{}. Run with {}; or state that it is not so with {}", text, fix_in_words(fixes),
                     fix_in_words(is_right));
}

/// Whether scans that a run leaves out have a Doppler.
bool has_doppler_elsewhere(const datasets::Dataset& dataset, diagnosis::DiagnosisConfig config,
                           const Workers& workers) {
  const bool is_part = config.begin > 0 || config.end < dataset.size();
  config.begin = 0;
  config.end = dataset.size();
  return is_part && diagnosis::diagnose(dataset, config, workers).has_doppler;
}

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
  const bool lacks_doppler = !diagnosis.has_doppler && needs.doppler && !settings.correction.doppler_kind;
  const bool is_at_rest = lacks_doppler && has_doppler_elsewhere(dataset, config, workers);
  if (is_at_rest) {
    check.warnings.push_back(
        "the Doppler of the scans looked at is exactly zero, but not that of the whole recording: the sensor seems to "
        "be at rest in these scans");
  } else if (lacks_doppler) {
    const auto with_kind = [&](DopplerKind kind) {
      diagnosis::Finding finding;
      finding.fix.doppler_kind = kind;
      return fix_in_words ? fmt::format(" ({})", fix_of(finding)) : "";
    };
    const std::string& sentence = diagnosis.of(diagnosis::Question::kDopplerKind).sentence;  // may end by asking
    throw DataError(fmt::format(
        "{}: {}{} Take a method that needs none, such as kiss-icp; or state the kind of Doppler: compensated, to go by "
        "the shape of the scene alone{}, or relative, if it is Doppler all the same{}",
        dataset.scan_file(scans.begin).string(), sentence, sentence.ends_with('?') ? "" : ".",
        with_kind(DopplerKind::kCompensated), with_kind(DopplerKind::kRelative)));
  }
  std::vector<const diagnosis::Finding*> stopping;
  for (const diagnosis::Finding& finding : diagnosis.findings) {
    const bool is_of_rest =
        is_at_rest && (finding.question == Question::kDopplerKind || finding.question == Question::kDopplerUnits);
    if (stops(finding, settings, diagnosis.has_doppler, needs)) {
      stopping.push_back(&finding);
    } else if (is_of_rest) {
      continue;
    } else if (finding.verdict == diagnosis::Verdict::kWrong || finding.verdict == diagnosis::Verdict::kSuspicious) {
      const std::string fix = fix_of(finding);
      check.warnings.push_back(fmt::format("{}: {}{}", diagnosis::to_string(finding.question), finding.sentence,
                                           fix.empty() ? "" : "; fix with " + fix));
    }
  }
  if (!stopping.empty()) {
    throw DataError(
        fmt::format("{}: {}", dataset.scan_file(scans.begin).string(), refusal(stopping, dataset, fix_in_words)));
  }
  if (needs.sweep) {
    check.sweep = diagnosis::search_sweep(dataset, {scans.begin, scans.end}, check.period_s, workers);
  }
  return check;
}

}  // namespace dynamic_icp::runs
