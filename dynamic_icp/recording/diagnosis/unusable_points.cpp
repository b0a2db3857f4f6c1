// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kMany = 0.5;  // sensors that write a point for every ray lose a third of them in the sky
constexpr double kHardlyAnyLeft = 0.99;

}  // namespace

Finding unusable_points(const Evidence& evidence) {
  Finding finding{Question::kUnusablePoints, Verdict::kOk, ""};
  double points = 0.0;
  double not_finite = 0.0;
  double implausible = 0.0;
  double at_origin = 0.0;
  double flagged = 0.0;
  for (const ScanLook& look : evidence.looks) {
    points += static_cast<double>(look.points);
    not_finite += static_cast<double>(look.dropped.non_finite);
    implausible += static_cast<double>(look.dropped.implausible);
    at_origin += static_cast<double>(look.dropped.zero_range);
    flagged += static_cast<double>(look.dropped.flagged);
  }
  finding.evidence = {{"points", points},
                      {"not_finite", not_finite},
                      {"implausible", implausible},
                      {"at_the_origin", at_origin},
                      {"flagged", flagged}};
  if (points == 0.0) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = "the sampled scans are empty";
    return finding;
  }
  const double share = (not_finite + implausible + at_origin + flagged) / points;
  finding.sentence = fmt::format("{:.1f} % not finite, {:.1f} % at the origin", 100.0 * not_finite / points,
                                 100.0 * at_origin / points);
  if (implausible > 0.0) {
    finding.sentence += fmt::format(", {:.1f} % beyond what a sensor measures", 100.0 * implausible / points);
  }
  if (flagged > 0.0) {
    finding.sentence += fmt::format(", {:.1f} % flagged by the sensor", 100.0 * flagged / points);
  }
  finding.verdict = share > kHardlyAnyLeft ? Verdict::kWrong : share > kMany ? Verdict::kSuspicious : Verdict::kOk;
  return finding;
}

}  // namespace dynamic_icp::diagnosis
