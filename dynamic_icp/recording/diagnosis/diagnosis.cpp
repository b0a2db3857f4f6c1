// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include <set>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"
#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {

namespace {

struct Asked {
  std::string_view name;
  Finding (*ask)(const Evidence&);
};

// In the order of their numbers, which is that of the findings.
constexpr Asked kAsked[] = {
    {"doppler_sign", doppler_sign},
    {"doppler_kind", doppler_kind},
    {"doppler_bias", doppler_bias},
    {"doppler_units", doppler_units},
    {"point_units", point_units},
    {"columns", columns},
    {"mounting", mounting},
    {"rig_mountings", rig_mountings},
    {"point_times", point_times},
    {"time_scale", time_scale},
    {"stamps", stamps},
    {"unusable_points", unusable_points},
};

// Told by the motion of all sensors together.
constexpr Question kOfTheWholeRig[] = {Question::kDopplerSign,  Question::kDopplerKind, Question::kDopplerBias,
                                       Question::kDopplerUnits, Question::kPointUnits,  Question::kMounting,
                                       Question::kPointTimes,   Question::kTimeScale};

constexpr std::string_view kVerdicts[] = {"ok", "wrong", "suspicious", "cannot_tell"};

/// Points and Doppler put together by wrong mountings look wrong in other ways, too: what is said of them then is no
/// finding, and no reason to refuse the recording.
void set_aside_by_mountings(std::vector<Finding>& findings) {
  const Verdict of_rig = findings[static_cast<std::size_t>(Question::kRigMountings)].verdict;
  if (of_rig != Verdict::kWrong && of_rig != Verdict::kSuspicious) {
    return;
  }
  for (const Question question : kOfTheWholeRig) {
    Finding& finding = findings[static_cast<std::size_t>(question)];
    if (finding.verdict == Verdict::kWrong || finding.verdict == Verdict::kSuspicious) {
      finding = {question, Verdict::kCannotTell, "not before the mountings of the sensors agree"};
    }
  }
}

}  // namespace

std::string_view to_string(Question question) { return kAsked[static_cast<std::size_t>(question)].name; }

std::string_view to_string(Verdict verdict) { return kVerdicts[static_cast<std::size_t>(verdict)]; }

const Finding& Diagnosis::of(Question question) const { return findings.at(static_cast<std::size_t>(question)); }

Diagnosis diagnose(const datasets::Dataset& dataset, const DiagnosisConfig& config, const Workers& workers) {
  const Evidence evidence = gather(dataset, config, workers);
  Diagnosis diagnosis;
  std::set<Stamp> stamps;  // stretches of a short recording overlap
  for (const ScanLook& look : evidence.looks) {
    stamps.insert(look.stamp);
  }
  diagnosis.scans_looked_at = stamps.size();
  diagnosis.period_s = evidence.period_s;
  const std::optional<NoDoppler> none = no_doppler(evidence);
  diagnosis.has_doppler = !none || none->may_be_static;
  for (const Asked& asked : kAsked) {
    diagnosis.findings.push_back(asked.ask(evidence));
  }
  set_aside_by_mountings(diagnosis.findings);
  return diagnosis;
}

}  // namespace dynamic_icp::diagnosis
