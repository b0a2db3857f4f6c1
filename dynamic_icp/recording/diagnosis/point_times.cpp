// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kLongestScan_s = 0.5;
constexpr double kMaxOverlap = 1.3;  // of the period: scans do not overlap much
constexpr double kBefore_s = 1e-3;

Finding without_times(const SweepSearch& search) {
  Finding finding{Question::kPointTimes, Verdict::kCannotTell, search.sentence};
  if (search.hypothesis != SweepHypothesis::kUnknown) {
    finding.verdict = search.found_sweep() ? Verdict::kSuspicious : Verdict::kOk;
  }
  finding.evidence = {{"sweep_duration_s", search.duration_s},
                      {"margin_sigma", search.margin},
                      {"azimuth_ccw_duration_s", search.by_azimuth.duration_s},
                      {"azimuth_ccw_sigma_s", search.by_azimuth.sigma_s},
                      {"as_stored_duration_s", search.as_stored.duration_s},
                      {"as_stored_sigma_s", search.as_stored.sigma_s}};
  return finding;
}

}  // namespace

Finding point_times(const Evidence& evidence) {
  Finding finding{Question::kPointTimes, Verdict::kOk, ""};
  bool any = false;
  double first = 0.0;
  double last = 0.0;
  for (const ScanLook& look : evidence.looks) {
    if (look.has_times) {
      first = any ? std::min(first, look.first_time_s) : look.first_time_s;
      last = any ? std::max(last, look.last_time_s) : look.last_time_s;
      any = true;
    }
  }
  if (!any && evidence.sweep) {
    return without_times(*evidence.sweep);
  }
  if (!any || (first == 0.0 && last == 0.0)) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = any ? "all points have the time 0: scans are taken as instant"
                           : "the points have no times: scans are taken as instant";
    return finding;
  }
  finding.evidence = {{"first_s", first}, {"last_s", last}, {"period_s", evidence.period_s}};
  if (last - first > kLongestScan_s || first < -kLongestScan_s) {
    finding.verdict = Verdict::kWrong;
    finding.sentence =
        fmt::format("{:.4g} to {:.4g} s after the stamp: no scan takes so long; not in seconds?", first, last);
  } else if (first < -kBefore_s) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format(
        "from {:.3f} s, before the stamp, to {:.3f} s: stamps are not those of the first points", first, last);
  } else if (evidence.period_s > 0.0 && last - first > kMaxOverlap * evidence.period_s) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format("a scan takes {:.3f} s, but scans follow each other every {:.3f} s", last - first,
                                   evidence.period_s);
  } else {
    finding.sentence = fmt::format("{:.3f} to {:.3f} s after the stamp", first, last);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
