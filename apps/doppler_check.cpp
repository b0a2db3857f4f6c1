// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/doppler_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/ego_motion/velocity_filter.hpp"

namespace dynamic_icp::apps {
namespace {

using formats::Trajectory;

constexpr std::size_t kScans = 10;
constexpr double kInlierMps = 0.5;
constexpr double kSlowMps = 0.5;
constexpr double kMovingMps = 1.5;
constexpr double kReferenceSpan_s = 0.5;  // long enough that repeated or noisy reference poses do not matter

/// Velocity over ground by the reference around a pose, in the sensor frame there (m/s).
std::optional<Eigen::Vector3d> reference_velocity(const Trajectory& truth, Stamp stamp) {
  const auto at = std::lower_bound(truth.begin(), truth.end(), stamp,
                                   [](const formats::StampedPose& pose, Stamp s) { return pose.stamp < s; });
  if (at == truth.end() || at->stamp != stamp) {
    return std::nullopt;
  }
  auto before = at;
  auto after = at;
  while (before != truth.begin() && seconds_between(before->stamp, stamp) < kReferenceSpan_s / 2) {
    --before;
  }
  while (after + 1 != truth.end() && seconds_between(stamp, after->stamp) < kReferenceSpan_s / 2) {
    ++after;
  }
  const double span = seconds_between(before->stamp, after->stamp);
  if (span <= 0.0) {
    return std::nullopt;
  }
  const Eigen::Vector3d displacement_world = after->T_world_sensor.translation() - before->T_world_sensor.translation();
  return at->T_world_sensor.linear().transpose() * displacement_world / span;
}

std::string verdict_with_reference(double ratio, double reference_speed, double doppler_speed) {
  const std::string evidence = fmt::format("ground truth {:.2f} m/s, Doppler {:.2f} m/s, along the motion {:.3f}",
                                           reference_speed, doppler_speed, ratio);
  if (reference_speed < kMovingMps) {
    return fmt::format("cannot tell: the sensor is too slow ({})", evidence);
  }
  if (doppler_speed < kSlowMps) {
    return fmt::format("compensated: the sensor's own motion seems to be taken out already ({})", evidence);
  }
  if (ratio < -0.5) {
    return fmt::format("relative, positive TOWARDS the sensor: the sign is the wrong way round ({})", evidence);
  }
  if (std::abs(ratio - 1.0) < 0.2) {
    return fmt::format("relative, positive away from the sensor ({})", evidence);
  }
  return fmt::format("unclear: Doppler and ground truth disagree; check units and time stamps ({})", evidence);
}

std::string verdict_without_reference(double doppler_speed, const Eigen::Vector3d& mean_velocity) {
  if (doppler_speed < kSlowMps) {
    return fmt::format("cannot tell: standing still, or the sensor's motion is taken out already ({:.2f} m/s)",
                       doppler_speed);
  }
  return mean_velocity.x() > 0.0
             ? "relative, positive away from the sensor, assuming that it looks where it drives (no ground truth)"
             : "relative; positive TOWARDS the sensor if it looks where it drives (no ground truth)";
}

double median(std::vector<double>& values) {
  if (values.empty()) {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

DopplerCheck check_doppler(const datasets::Dataset& dataset, const Workers& workers) {
  DopplerCheck check;
  std::vector<double> residuals;
  std::size_t inliers = 0;
  Eigen::Vector3d velocity_sum = Eigen::Vector3d::Zero();
  double along = 0.0;
  double reference_squared = 0.0;
  double reference_speed = 0.0;
  std::size_t referenced = 0;
  const std::size_t count = std::min(kScans, dataset.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = (2 * k + 1) * dataset.size() / (2 * count);
    const Scan scan = Scan::from_raw(dataset.scan(index));
    const ego_motion::EgoVelocity ego = ego_motion::estimate_velocity(scan, Eigen::Vector3d::Zero(), {}, workers);
    if (ego.status != ego_motion::EgoVelocityStatus::kConverged) {
      continue;
    }
    ++check.scans;
    velocity_sum += ego.velocity_sensor;
    check.mean_speed_mps += ego.velocity_sensor.norm();
    for (const double residual : ego_motion::compensated_doppler(scan, ego.velocity_sensor)) {
      residuals.push_back(std::abs(residual));
      inliers += std::abs(residual) < kInlierMps ? 1 : 0;
    }
    if (const auto reference = reference_velocity(dataset.ground_truth(), dataset.stamp(index))) {
      along += reference->dot(ego.velocity_sensor);
      reference_squared += reference->squaredNorm();
      reference_speed += reference->norm();
      ++referenced;
    }
  }
  if (check.scans == 0) {
    check.verdict = "cannot tell: no scan has enough points for a velocity";
    return check;
  }
  check.mean_speed_mps /= static_cast<double>(check.scans);
  check.inlier_share = static_cast<double>(inliers) / static_cast<double>(residuals.size());
  check.median_residual_mps = median(residuals);
  if (referenced > 0) {
    reference_speed /= static_cast<double>(referenced);
    if (reference_squared > 0.0) {
      check.speed_ratio = along / reference_squared;
    }
    check.verdict = verdict_with_reference(check.speed_ratio.value_or(0.0), reference_speed, check.mean_speed_mps);
  } else {
    check.verdict = verdict_without_reference(check.mean_speed_mps, velocity_sum);
  }
  return check;
}

}  // namespace dynamic_icp::apps
