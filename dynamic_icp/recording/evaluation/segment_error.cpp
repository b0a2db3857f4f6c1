// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/segment_error.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/recording/evaluation/relative_error.hpp"

namespace dynamic_icp::evaluation {
namespace {

constexpr std::size_t kStartStep = 10;
constexpr double kLengthStepM = 100.0;
constexpr int kLengthCount = 8;

struct SegmentSum {
  std::size_t count = 0;
  double translation_percent = 0.0;
  double rotation_deg_per_100m = 0.0;

  void add(const MotionError& error, double length_m) {
    ++count;
    translation_percent += 100.0 * error.translation_m / length_m;
    rotation_deg_per_100m += 100.0 * error.rotation_deg / length_m;
  }
};

SegmentMean mean_of(const SegmentSum& sum) {
  if (sum.count == 0 || !std::isfinite(sum.translation_percent) || !std::isfinite(sum.rotation_deg_per_100m)) {
    return {sum.count, std::nullopt, std::nullopt};
  }
  const auto count = static_cast<double>(sum.count);
  return {sum.count, sum.translation_percent / count, sum.rotation_deg_per_100m / count};
}

}  // namespace

SegmentError segment_error(const Association& matched) {
  const std::vector<double> distances_m = path_distances(matched.reference);
  SegmentError result;
  SegmentSum all;
  for (int k = 1; k <= kLengthCount; ++k) {
    const double length_m = k * kLengthStepM;
    SegmentSum sum;
    for (std::size_t from = 0; from < matched.size(); from += kStartStep) {
      const auto end = std::upper_bound(distances_m.begin(), distances_m.end(), distances_m[from] + length_m);
      if (end == distances_m.end()) {
        break;  // later starts do not get that far either
      }
      const MotionError error = motion_error(matched, from, static_cast<std::size_t>(end - distances_m.begin()));
      sum.add(error, length_m);
      all.add(error, length_m);
    }
    result.lengths.push_back({length_m, mean_of(sum)});
  }
  result.all = mean_of(all);
  return result;
}

}  // namespace dynamic_icp::evaluation
