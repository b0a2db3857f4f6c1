// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/same_recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace dynamic_icp::figures {
namespace {

constexpr double kMinShare = 0.95;
constexpr double kMaxStampDifference_s = 1e-3;

/// Calls visit(i, j) with the frames of every scan that both runs have.
template <class Visit>
void for_common_scans(const runs::RunFiles& a, const runs::RunFiles& b, const Visit& visit) {
  std::size_t j = 0;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    while (j < b.frames.size() && b.frames[j].index < a.frames[i].index) {
      ++j;
    }
    if (j < b.frames.size() && b.frames[j].index == a.frames[i].index) {
      visit(i, j);
    }
  }
}

bool have_same_scans(const runs::RunFiles& a, const runs::RunFiles& b) {
  std::size_t common = 0;
  std::size_t equal = 0;
  std::set<double> counts;
  std::optional<double> offset_s;
  for_common_scans(a, b, [&](std::size_t i, std::size_t j) {
    const double apart_s = a.seconds(i) - b.seconds(j);
    offset_s = offset_s.value_or(apart_s);
    counts.insert(a.frames[i].points);
    ++common;
    const bool is_equal =
        a.frames[i].points == b.frames[j].points && std::abs(apart_s - *offset_s) < kMaxStampDifference_s;
    equal += is_equal ? 1 : 0;
  });
  return counts.size() > 1 && static_cast<double>(equal) >= kMinShare * static_cast<double>(common);
}

}  // namespace

bool is_same_recording(const runs::RunFiles& a, const runs::RunFiles& b) {
  return runs::text_of(a.run, "input.path") == runs::text_of(b.run, "input.path") || have_same_scans(a, b);
}

std::optional<RunDifference> difference(const runs::RunFiles& a, const runs::RunFiles& b) {
  RunDifference largest;
  for_common_scans(a, b, [&](std::size_t i, std::size_t j) {
    const Eigen::Isometry3d& p = a.trajectory[i].T_world_sensor;
    const Eigen::Isometry3d& q = b.trajectory[j].T_world_sensor;
    ++largest.scans;
    largest.translation_m = std::max(largest.translation_m, (p.translation() - q.translation()).norm());
    largest.rotation_deg =
        std::max(largest.rotation_deg, Eigen::Quaterniond(p.linear()).angularDistance(Eigen::Quaterniond(q.linear())) *
                                           180.0 / std::numbers::pi);
  });
  return largest.scans > 0 ? std::optional(largest) : std::nullopt;
}

}  // namespace dynamic_icp::figures
