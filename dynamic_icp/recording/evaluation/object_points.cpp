// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_points.hpp"

#include <algorithm>
#include <stdexcept>

#include "dynamic_icp/recording/evaluation/statistics.hpp"

namespace dynamic_icp::evaluation {
namespace {

/// Where a point that was fixed to a body at a time after the stamp was at the stamp, sensor frame at the stamp.
Eigen::Vector3d moved_back(const Eigen::Vector3d& point, double time_s, const Body& body) {
  const Eigen::Isometry3d& T = body.box.T_sensor_box;
  const Eigen::Vector3d center = T.translation();
  const Eigen::Vector3d axis = T.linear().col(2);
  return center + Eigen::AngleAxisd(-body.yaw_rate_rps * time_s, axis) * (point - time_s * body.velocity - center);
}

}  // namespace

double distance_to(const Box& box, const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_box = box.T_sensor_box.inverse() * point;
  return (in_box.cwiseAbs() - 0.5 * box.size).cwiseMax(0.0).norm();
}

std::optional<double> held_share(const BodyPair& pair, const PointsOnBodies& scan, const SensorMotion& T_stamp_time) {
  if (scan.labels.size() != scan.points.size() || (!scan.times.empty() && scan.times.size() != scan.points.size())) {
    throw std::invalid_argument("held_share: expected a label and a time for each point");
  }
  std::size_t all = 0;
  std::size_t held = 0;
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    if (scan.labels[k] != pair.truth.id || !scan.points[k].allFinite()) {
      continue;
    }
    Eigen::Vector3d point = scan.points[k];
    if (!scan.times.empty()) {
      const std::optional<Eigen::Isometry3d> T = T_stamp_time(scan.times[k]);
      if (!T) {
        continue;
      }
      point = moved_back(*T * point, scan.times[k], pair.truth);
    }
    ++all;
    held += distance_to(pair.reported.box, point) <= kHeldWithin_m ? 1 : 0;
  }
  return all > 0 ? std::optional(static_cast<double>(held) / static_cast<double>(all)) : std::nullopt;
}

HeldPoints held_points(std::vector<double> shares) {
  if (shares.empty()) {
    return {};
  }
  std::sort(shares.begin(), shares.end());
  return {percentile(shares, 50.0), percentile(shares, 5.0)};
}

void StaticPoints::add(std::span<const std::int32_t> reported, std::span<const std::int32_t> truth) {
  if (reported.size() != truth.size()) {
    throw std::invalid_argument("StaticPoints: expected labels of the same points");
  }
  for (std::size_t k = 0; k < reported.size(); ++k) {
    all += reported[k] == 0 ? 1 : 0;
    on_moving += reported[k] == 0 && truth[k] > 0 ? 1 : 0;
  }
}

std::optional<double> StaticPoints::share_on_moving() const {
  return all > 0 ? std::optional(static_cast<double>(on_moving) / static_cast<double>(all)) : std::nullopt;
}

}  // namespace dynamic_icp::evaluation
