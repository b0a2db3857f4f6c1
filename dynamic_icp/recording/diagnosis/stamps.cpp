// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kGapPeriods = 1.5;
constexpr double kLongestPeriod_s = 10.0;

/// Of milli-, micro- and nanoseconds the largest that brings a period below the longest, s.
double likely_unit(double period_s) {
  double unit = 1e-3;
  while (unit > 1e-9 && period_s * unit > kLongestPeriod_s) {
    unit *= 1e-3;
  }
  return unit;
}

}  // namespace

Finding stamps(const Evidence& evidence) {
  Finding finding{Question::kStamps, Verdict::kOk, ""};
  const datasets::Dataset& dataset = *evidence.dataset;
  std::size_t gaps = 0;
  std::size_t first_gap = 0;
  double longest = 0.0;
  std::size_t back = 0;
  std::size_t first_back = 0;
  for (std::size_t i = evidence.begin + 1; i < evidence.end; ++i) {
    const double period = seconds_between(dataset.stamp(i - 1), dataset.stamp(i));
    longest = std::max(longest, period);
    if (period <= 0.0) {
      first_back = back++ == 0 ? i : first_back;
    } else if (period > kGapPeriods * evidence.period_s) {
      first_gap = gaps++ == 0 ? i : first_gap;
    }
  }
  finding.evidence = {{"period_s", evidence.period_s},
                      {"longest_s", longest},
                      {"gaps", static_cast<double>(gaps)},
                      {"not_later", static_cast<double>(back)}};
  if (evidence.end - evidence.begin < 2) {
    finding.verdict = Verdict::kCannotTell;
    finding.sentence = "fewer than two scans";
  } else if (back > 0) {
    finding.verdict = Verdict::kWrong;
    finding.sentence =
        fmt::format("{} scans are not later than the one before, the first is scan {}", back, first_back);
  } else if (gaps > 0) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = fmt::format("{} gaps of more than {} periods, the first before scan {}, the longest {:.3f} s",
                                   gaps, kGapPeriods, first_gap, longest);
  } else if (evidence.period_s > kLongestPeriod_s) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence =
        fmt::format("a scan every {:g} s: no sensor is so slow; the stamps may count milli-, micro- or nanoseconds",
                    evidence.period_s);
    finding.fix.time_scale = rounded(evidence.applied.time_scale.value_or(1.0) * likely_unit(evidence.period_s), 6);
  } else {
    finding.sentence = fmt::format("increasing, every {:.4f} s, without gaps", evidence.period_s);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
