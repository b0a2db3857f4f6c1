// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/worst_frames.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::report {
namespace {

/// How bad a frame is, more is worse; NaN where nothing is wrong with it or nothing is known.
double badness(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth, std::size_t frame) {
  if (truth) {
    return truth->translation_error[frame];
  }
  const std::string& status = run.frames[frame].status;
  return status == "lost" ? 2.0 : status == "degenerate" ? 1.0 : std::nan("");
}

}  // namespace

std::vector<std::size_t> worst_frames(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth,
                                      std::size_t most) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    if (const double value = badness(run, truth, k); std::isfinite(value)) {
      ranked.emplace_back(-value, k);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> worst;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k) {
    worst.push_back(ranked[k].second);
  }
  return worst;
}

}  // namespace dynamic_icp::report
