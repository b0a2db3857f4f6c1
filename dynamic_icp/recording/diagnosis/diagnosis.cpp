// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include <stdexcept>

#include "dynamic_icp/recording/diagnosis/evidence.hpp"
#include "dynamic_icp/recording/diagnosis/no_doppler.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {

std::string_view to_string(Question question) {
  switch (question) {
    case Question::kDopplerSign:
      return "doppler_sign";
    case Question::kDopplerKind:
      return "doppler_kind";
    case Question::kDopplerBias:
      return "doppler_bias";
    case Question::kDopplerUnits:
      return "doppler_units";
    case Question::kPointUnits:
      return "point_units";
    case Question::kColumns:
      return "columns";
    case Question::kMounting:
      return "mounting";
    case Question::kPointTimes:
      return "point_times";
    case Question::kTimeScale:
      return "time_scale";
    case Question::kStamps:
      return "stamps";
    case Question::kUnusablePoints:
      return "unusable_points";
  }
  return "unknown";
}

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kWrong:
      return "wrong";
    case Verdict::kSuspicious:
      return "suspicious";
    case Verdict::kCannotTell:
      return "cannot_tell";
  }
  return "unknown";
}

const Finding& Diagnosis::of(Question question) const {
  for (const Finding& finding : findings) {
    if (finding.question == question) {
      return finding;
    }
  }
  throw std::out_of_range("the diagnosis does not answer this question");
}

Diagnosis diagnose(const datasets::Dataset& dataset, const DoctorConfig& config, const Workers& workers) {
  const Evidence evidence = gather(dataset, config, workers);
  Diagnosis diagnosis;
  diagnosis.scans_looked_at = evidence.looks.size();
  diagnosis.period_s = evidence.period_s;
  const std::optional<NoDoppler> none = no_doppler(evidence);
  diagnosis.has_doppler = !none || none->may_stand;
  for (const auto ask : {doppler_sign, doppler_kind, doppler_bias, doppler_units, point_units, columns, mounting,
                         point_times, time_scale, stamps, unusable_points}) {
    diagnosis.findings.push_back(ask(evidence));
  }
  return diagnosis;
}

}  // namespace dynamic_icp::diagnosis
