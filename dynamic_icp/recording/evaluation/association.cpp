// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/association.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

namespace dynamic_icp::evaluation {
namespace {

using formats::StampedPose;
using formats::Trajectory;

constexpr std::int64_t kStampRoundingNs = 1000;

void check_trajectory(const Trajectory& trajectory, const char* name) {
  if (trajectory.empty()) {
    throw DataError(fmt::format("the {} has no poses, expected at least one", name));
  }
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    if (!trajectory[k].T_world_sensor.matrix().allFinite()) {
      throw DataError(fmt::format("pose {} of the {} (at {} s) is not finite, expected finite numbers", k, name,
                                  format_seconds(trajectory[k].stamp)));
    }
    if (k > 0 && trajectory[k].stamp <= trajectory[k - 1].stamp) {
      throw DataError(
          fmt::format("pose {} of the {} (at {} s) is not later than the pose before it, expected "
                      "increasing stamps",
                      k, name, format_seconds(trajectory[k].stamp)));
    }
  }
}

/// The reference pose at `stamp`; `after` is the index of the first reference pose not earlier than that.
std::optional<Eigen::Isometry3d> pose_at(const Trajectory& reference, std::size_t after, Stamp stamp,
                                         std::int64_t max_gap_ns) {
  const bool has_after = after < reference.size();
  const bool has_before = after > 0;
  if (has_after && reference[after].stamp == stamp) {
    return reference[after].T_world_sensor;
  }
  if (has_before && has_after && reference[after].stamp.ns - reference[after - 1].stamp.ns <= max_gap_ns) {
    return formats::interpolate(reference[after - 1], reference[after], stamp);
  }
  if (has_before && stamp.ns - reference[after - 1].stamp.ns <= kStampRoundingNs) {
    return reference[after - 1].T_world_sensor;
  }
  if (has_after && reference[after].stamp.ns - stamp.ns <= kStampRoundingNs) {
    return reference[after].T_world_sensor;
  }
  return std::nullopt;
}

double duration_s(const Trajectory& trajectory) {
  return seconds_between(trajectory.front().stamp, trajectory.back().stamp);
}

std::string span_text(const Trajectory& trajectory) {
  return fmt::format("{} poses from {} to {} s", trajectory.size(), format_seconds(trajectory.front().stamp),
                     format_seconds(trajectory.back().stamp));
}

/// A guess at why no pose matched, for the message.
std::string mismatch_guess(const Trajectory& estimate, const Trajectory& reference, double max_gap_s) {
  const double ratio = duration_s(estimate) / std::max(duration_s(reference), 1e-9);
  for (const double unit : {1e3, 1e6, 1e9}) {
    for (const double factor : {unit, 1.0 / unit}) {
      if (std::abs(ratio / factor - 1.0) < 0.3) {
        return fmt::format("one of them seems to count in another unit (the time spans differ by a factor of {:g})",
                           unit);
      }
    }
  }
  if (estimate.front().stamp <= reference.back().stamp && reference.front().stamp <= estimate.back().stamp) {
    return fmt::format("the times overlap, but no estimated pose lies between two reference poses at most {:g} s apart",
                       max_gap_s);
  }
  constexpr double kRelativeTimeS = 1e5;
  constexpr double kUnixTimeS = 1e9;
  const double starts[] = {seconds_between({0}, estimate.front().stamp), seconds_between({0}, reference.front().stamp)};
  const char* clocks = std::min(starts[0], starts[1]) < kRelativeTimeS && std::max(starts[0], starts[1]) > kUnixTimeS
                           ? "one counts from the start of the recording and the other gives Unix time; "
                           : "";
  return fmt::format("{}the reference starts {} s after the estimate", clocks,
                     format_seconds({reference.front().stamp.ns - estimate.front().stamp.ns}));
}

}  // namespace

ConfigFields fields(AssociationConfig& config) {
  return {{"max_gap_s", &config.max_gap_s, 0.0, 1e6, "s",
           "largest time between two reference poses for a pose to be interpolated between them"}};
}

Association associate(const Trajectory& estimate, const Trajectory& reference, const AssociationConfig& config) {
  AssociationConfig checked = config;
  check_fields(fields(checked));
  check_trajectory(estimate, "estimate");
  check_trajectory(reference, "reference");
  const auto max_gap_ns = static_cast<std::int64_t>(std::llround(checked.max_gap_s * 1e9));
  Association result;
  result.estimate_count = estimate.size();
  result.reference_count = reference.size();
  std::size_t after = 0;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const Stamp stamp = estimate[k].stamp;
    while (after < reference.size() && reference[after].stamp < stamp) {
      ++after;
    }
    if (const std::optional<Eigen::Isometry3d> T = pose_at(reference, after, stamp, max_gap_ns)) {
      result.estimate.push_back(estimate[k]);
      result.reference.push_back({stamp, *T});
      result.estimate_indices.push_back(k);
      result.exact_count += after < reference.size() && reference[after].stamp == stamp ? 1 : 0;
    }
  }
  if (result.size() == 0) {
    throw DataError(
        fmt::format("no time stamp of the estimate matches the reference: expected overlapping times, but "
                    "the estimate has {} and the reference {}; {}",
                    span_text(estimate), span_text(reference), mismatch_guess(estimate, reference, checked.max_gap_s)));
  }
  return result;
}

std::vector<double> path_distances(const Trajectory& trajectory) {
  std::vector<double> distances_m;
  distances_m.reserve(trajectory.size());
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    distances_m.push_back(
        k == 0
            ? 0.0
            : distances_m[k - 1] +
                  (trajectory[k].T_world_sensor.translation() - trajectory[k - 1].T_world_sensor.translation()).norm());
  }
  return distances_m;
}

}  // namespace dynamic_icp::evaluation
