// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/frame_labels.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr std::size_t kLabelBlock = 4096;

void count_dynamics(Frame& frame, const std::vector<std::uint8_t>& is_dynamic,
                    const std::vector<std::int32_t>& labels) {
  for (std::size_t row = 0; row < is_dynamic.size(); ++row) {
    frame.dynamic_candidates += is_dynamic[row];
    frame.dynamic_clustered += labels[row] >= 0 ? 1 : 0;
  }
  for (const dynamics::ObjectEstimate& object : frame.clusters) {
    frame.dynamic_refined += object.members.size();
  }
}

void label_points(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_dynamic) {
  frame.labels.assign(frame.points, -1);
  for (std::size_t row = 0; row < scan.size(); ++row) {
    frame.labels[scan.records()[row]] = is_dynamic[row] != 0 ? -1 : 0;
    if (is_dynamic[row] == 0) {
      frame.static_points.push_back(scan.points()[row]);
    }
  }
  std::int32_t id = 0;
  for (const dynamics::ObjectEstimate& object : frame.clusters) {
    id += object.verdict == dynamics::ClusterVerdict::kAccepted ? 1 : 0;
    for (const std::uint32_t row : object.members) {
      frame.labels[scan.records()[row]] = id;
    }
  }
}

}  // namespace

void describe_clusters(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_dynamic,
                       const std::vector<std::int32_t>& cluster_labels) {
  count_dynamics(frame, is_dynamic, cluster_labels);
  label_points(frame, scan, is_dynamic);
}

void describe_tracks(Frame& frame, const Scan& scan, const std::vector<std::uint8_t>& is_moving,
                     std::span<const std::uint32_t> thinned, std::span<const tracking::TrackedObject> objects,
                     const Workers& workers) {
  workers.for_each(scan.size(), kLabelBlock,
                   [&](std::size_t row) { frame.labels[scan.records()[row]] = is_moving[row] != 0 ? -1 : 0; });
  std::vector<std::uint8_t> in_track(scan.size(), 0);
  for (const tracking::TrackedObject& object : objects) {
    const bool is_confirmed = object.status == tracking::TrackStatus::kConfirmed;
    for (const std::uint32_t row : object.members) {
      in_track[row] = 1;
      if (is_confirmed) {
        frame.labels[scan.records()[row]] = static_cast<std::int32_t>(object.id);
      }
    }
    if (is_confirmed) {
      frame.tracked.push_back(object);
    }
  }
  for (const std::uint32_t row : thinned) {
    if (is_moving[row] != 0) {
      ++frame.dynamic_candidates;
      frame.dynamic_clustered += in_track[row];
      frame.dynamic_refined += frame.labels[scan.records()[row]] > 0 ? 1 : 0;
    }
  }
}

}  // namespace dynamic_icp::odometry
