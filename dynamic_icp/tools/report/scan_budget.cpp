// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/scan_budget.hpp"

#include <algorithm>
#include <cmath>

namespace dynamic_icp::report {
namespace {

/// Where the largest finite value stands; nothing when there is none.
std::optional<std::size_t> largest(const std::vector<double>& values) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(values[k]) && (!best || values[k] > values[*best])) {
      best = k;
    }
  }
  return best;
}

}  // namespace

std::size_t even_share(std::span<const std::size_t> points, std::size_t total) {
  std::vector<std::size_t> ascending(points.begin(), points.end());
  std::sort(ascending.begin(), ascending.end());
  std::size_t left = total;
  for (std::size_t k = 0; k < ascending.size(); ++k) {
    const std::size_t share = left / (ascending.size() - k);
    if (ascending[k] > share) {
      return share;
    }
    left -= ascending[k];
  }
  return ascending.empty() ? total : ascending.back();
}

std::vector<std::size_t> spread_frames(std::size_t n, std::size_t count) {
  std::vector<std::size_t> frames;
  if (n == 0 || count == 0) {
    return frames;
  }
  if (count == 1) {
    return {0};
  }
  const std::size_t steps = std::min(n, count) - 1;
  for (std::size_t k = 0; k <= steps; ++k) {
    frames.push_back(steps == 0 ? 0 : k * (n - 1) / steps);
  }
  return frames;
}

std::vector<std::size_t> informative_frames(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth) {
  std::vector<std::size_t> frames;
  if (run.frames.empty()) {
    return frames;
  }
  frames = {0, run.frames.size() / 2, figures::frame_with_most_object_points(run)};
  if (truth) {
    for (const std::vector<double>* errors : {&truth->translation_error, &truth->rotation_error}) {
      if (const std::optional<std::size_t> worst = largest(*errors)) {
        frames.push_back(*worst);
      }
    }
  }
  for (const char* status : {"degenerate", "lost"}) {
    const auto found = std::find_if(run.frames.begin(), run.frames.end(),
                                    [&](const runs::FrameRow& row) { return row.status == status; });
    if (found != run.frames.end()) {
      frames.push_back(static_cast<std::size_t>(found - run.frames.begin()));
    }
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

KeptFrames kept_frames(std::span<const std::size_t> points, std::span<const std::size_t> whole, std::size_t total) {
  std::vector<std::size_t> others;
  std::vector<std::size_t> points_of_others;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::find(whole.begin(), whole.end(), k) == whole.end()) {
      others.push_back(k);
      points_of_others.push_back(points[k]);
    }
  }
  std::size_t share = even_share(points_of_others, total);
  const bool any_is_thinned =
      std::any_of(points_of_others.begin(), points_of_others.end(), [&](std::size_t n) { return n > share; });
  if (share < kMinPoints && any_is_thinned) {
    std::vector<std::size_t> fewer;
    std::vector<std::size_t> points_of_fewer;
    for (const std::size_t place : spread_frames(others.size(), total / kMinPoints)) {
      fewer.push_back(others[place]);
      points_of_fewer.push_back(points_of_others[place]);
    }
    others = std::move(fewer);
    share = even_share(points_of_fewer, total);
  }
  KeptFrames kept{.frames = std::move(others), .points = share};
  const auto middle = static_cast<std::ptrdiff_t>(kept.frames.size());
  kept.frames.insert(kept.frames.end(), whole.begin(), whole.end());
  std::inplace_merge(kept.frames.begin(), kept.frames.begin() + middle, kept.frames.end());
  return kept;
}

}  // namespace dynamic_icp::report
