// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/run_summary_text.hpp"

#include <optional>

#include <fmt/format.h>

#include "apps/sweep_advice.hpp"

namespace dynamic_icp::apps {
namespace {

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100.0 * *share) : "-";
}

std::string sweep_text(const runs::SweepRecord& sweep, double period_s) {
  if (sweep.times() == "none") {
    if (!sweep.search) {
      return "none: the points have no times";
    }
    const bool is_unknown = sweep.search->hypothesis == diagnosis::SweepHypothesis::kUnknown;
    return sweep.search->sentence + (is_unknown ? "; " + sweep_advice(period_s) : "");
  }
  return fmt::format("{}, {} s, times {}", sweep.deskewed() ? "deskewed" : "not deskewed", cell(sweep.duration_s(), 3),
                     sweep.times());
}

/// One pose has no error, and two that were not compared neither.
std::string accuracy_text(const runs::RunSummary& summary) {
  const evaluation::RunAccuracy& accuracy = summary.accuracy;
  if (accuracy.matched == 0) {
    return "";
  }
  if (!accuracy.rte_rmse_m || !accuracy.ate_rmse_m) {
    return fmt::format("accuracy     none: {} of {} poses matched\n", accuracy.matched, summary.frames);
  }
  return fmt::format("RTE          {} m RMSE, {} m median (frame to frame)\n", cell(accuracy.rte_rmse_m, 4),
                     cell(accuracy.rte_median_m, 4)) +
         fmt::format("RRE          {} deg RMSE, {} deg median\n", cell(accuracy.rre_rmse_deg, 4),
                     cell(accuracy.rre_median_deg, 4)) +
         fmt::format("ATE          {} m RMSE over {} m (SE(3) aligned, {} of {} poses matched)\n",
                     cell(accuracy.ate_rmse_m, 3), cell(accuracy.path_length_m, 1), accuracy.matched, summary.frames);
}

std::string latency_text(const runs::Latency& latency) {
  return latency.scans == 0 ? ""
                            : fmt::format("latency      {:.0f} ms median, {:.0f} ms at most in 99 % of {} scans\n",
                                          latency.median_ms, latency.p99_ms, latency.scans);
}

}  // namespace

std::string status_text(const runs::RunSummary& summary) {
  std::string text;
  for (std::size_t i = 0; i < odometry::kVerdicts.size(); ++i) {
    const std::string_view word = odometry::kVerdicts.at(i);
    std::string reasons;
    for (const auto& [status, count] : summary.reasons) {
      if (odometry::verdict(status) == word && word != odometry::kVerdicts.front()) {
        reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, to_string(status));
      }
    }
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", summary.verdicts.at(i), word,
                        reasons.empty() ? "" : " (" + reasons + ")");
  }
  return text;
}

std::string summary_text(const runs::RunResult& result) {
  const runs::RunSummary& summary = result.summary;
  std::string text = fmt::format("scans        {}\n", summary.frames);
  if (result.period_s > 0.0) {
    text += fmt::format("rate         {:.2f} Hz\n", 1.0 / result.period_s);
  }
  text += fmt::format("Doppler      {}\n", result.doppler);
  text += fmt::format("sweep        {}\n", sweep_text(result.sweep, result.period_s));
  text += fmt::format("status       {}\n", status_text(summary));
  text += fmt::format("converged    {}   iterations {}\n", percent(summary.convergence_rate),
                      cell(summary.mean_iterations, 1));
  text += fmt::format("time         {} ms a scan (median {}, p95 {})\n", cell(summary.ms_mean, 1),
                      cell(summary.ms_median, 1), cell(summary.ms_p95, 1));
  text += fmt::format("moving       {} of the points ({} clustered)\n", percent(summary.dynamic_ratio_mean),
                      percent(summary.clustered_ratio_mean));
  return text + latency_text(result.latency) + accuracy_text(summary);
}

}  // namespace dynamic_icp::apps
