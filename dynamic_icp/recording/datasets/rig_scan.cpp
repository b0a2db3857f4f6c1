// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/rig_scan.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace dynamic_icp::datasets {

std::vector<std::vector<std::size_t>> nearest_in_time(const std::vector<Stamp>& stamps,
                                                      const std::vector<std::vector<Stamp>>& others,
                                                      double max_distance_s) {
  std::vector<std::vector<std::size_t>> nearest(stamps.size(), std::vector<std::size_t>(others.size(), kAbsent));
  for (std::size_t k = 0; k < others.size(); ++k) {
    const std::vector<Stamp>& row = others[k];
    const auto distance_s = [&](std::size_t i, std::size_t other) {
      return std::abs(seconds_between(stamps[i], row[other]));
    };
    std::size_t other = 0;
    for (std::size_t i = 0; i < stamps.size() && !row.empty(); ++i) {
      while (other + 1 < row.size() && distance_s(i, other + 1) <= distance_s(i, other)) {
        ++other;
      }
      const bool is_nearer_to_next = i + 1 < stamps.size() && distance_s(i + 1, other) < distance_s(i, other);
      if (distance_s(i, other) <= max_distance_s && !is_nearer_to_next) {
        nearest[i][k] = other;
      }
    }
  }
  return nearest;
}

void append_sensor(const RawScan& scan, std::size_t sensor, bool has_times, RawScan& rig) {
  const std::size_t before = rig.points.size();
  const Eigen::Isometry3d& T = rig.mountings.at(sensor);
  const double later_s = seconds_between(rig.stamp, scan.stamp);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d& point = scan.points[i];
    // No line of sight leads to the sensor's own origin: the zero that stays here marks the point as unusable.
    const Eigen::Vector3d line_of_sight = scan.directions.empty() ? point.stableNormalized() : scan.directions[i];
    rig.points.emplace_back(T * point);
    rig.directions.emplace_back(T.linear() * line_of_sight);
    if (has_times) {
      rig.times.push_back(later_s + (scan.times.empty() ? 0.0 : scan.times[i]));
    }
  }
  const auto add = [&](const auto& from, auto& to) {
    if (to.size() == before) {
      to.insert(to.end(), from.begin(), from.end());
    }
  };
  add(scan.doppler, rig.doppler);
  add(scan.channels.line, rig.channels.line);
  add(scan.channels.face, rig.channels.face);
  add(scan.channels.intensity, rig.channels.intensity);
  add(scan.channels.return_number, rig.channels.return_number);
  if (!scan.is_unusable.empty() || !rig.is_unusable.empty()) {
    rig.is_unusable.resize(before, 0);
    rig.is_unusable.insert(rig.is_unusable.end(), scan.is_unusable.begin(), scan.is_unusable.end());
    rig.is_unusable.resize(rig.points.size(), 0);
  }
  rig.channels.sensor.resize(rig.points.size(), static_cast<std::uint8_t>(sensor));
  if (!scan.warning.empty()) {
    rig.warning += (rig.warning.empty() ? "" : "; ") + scan.warning;
  }
}

void drop_partial_channels(RawScan& rig) {
  const auto drop_partial = [&](auto& column) {
    column.resize(column.size() == rig.points.size() ? column.size() : 0);
  };
  drop_partial(rig.channels.line);
  drop_partial(rig.channels.face);
  drop_partial(rig.channels.intensity);
  drop_partial(rig.channels.return_number);
}

}  // namespace dynamic_icp::datasets
