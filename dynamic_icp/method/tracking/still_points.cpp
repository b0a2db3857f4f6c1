// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/still_points.hpp"

#include <algorithm>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kGroundClearance_m = 0.3;  // points lower in a box may be the road ...
constexpr double kGroundShare = 0.25;       // ... but at most so much of its height is left out

constexpr std::size_t kBlock = 4096;

/// A still point in the box of an expectation.
struct Hit {
  std::uint32_t expectation;
  std::uint32_t row;
  Vector3d direction_world;
};

OrientedBox above_ground(OrientedBox box) {
  const double clearance = std::min(kGroundClearance_m, kGroundShare * box.size.z());
  box.size.z() -= clearance;
  box.centre.z() += 0.5 * clearance;
  return box;
}

}  // namespace

void visit_still_points(const TrackingInput& input, std::span<const Expectation> expectations, const Workers& workers,
                        const StillVisitor& visit) {
  if (expectations.empty()) {
    return;
  }
  std::vector<OrientedBox> boxes;
  std::vector<std::vector<std::uint32_t>> boxes_of_column(static_cast<std::size_t>(RangeImage::column_count()));
  const Eigen::Isometry3d T_sensor_world = input.sensor.T_world_sensor.inverse();
  for (const Expectation& expected : expectations) {
    const OrientedBox box = above_ground(expected.box);
    // What moves during the sweep is not seen where it is at the stamp.
    const double reach = 0.5 * box.size.norm() + input.sweep_s * expected.velocity.norm();
    const RangeImage::ColumnRange range = RangeImage::columns_around(T_sensor_world * box.centre, reach);
    for (int i = 0; i < range.count; ++i) {
      boxes_of_column[static_cast<std::size_t>((range.first + i) % RangeImage::column_count())].push_back(
          static_cast<std::uint32_t>(boxes.size()));
    }
    boxes.push_back(box);
  }
  const std::size_t rows = input.scan.size();
  std::vector<std::vector<Hit>> hits(Workers::block_count(rows, kBlock));
  workers.for_blocks(rows, kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::vector<std::uint32_t>& candidates = boxes_of_column[input.view.columns()[row]];
      if (candidates.empty() || input.is_moving[row] != 0) {
        continue;
      }
      const double time = input.scan.has_times() ? input.scan.times()[row] : 0.0;
      const Vector3d point = input.sensor.T_world_sensor * input.scan.points()[row];
      for (const std::uint32_t i : candidates) {
        if (distance_outside(boxes[i], point - time * expectations[i].velocity) <= 0.0) {
          hits[block].push_back(
              {i, static_cast<std::uint32_t>(row), input.sensor.direction_world(input.scan.directions()[row], time)});
        }
      }
    }
  });
  for (const std::vector<Hit>& of_block : hits) {
    for (const Hit& hit : of_block) {
      visit(hit.expectation, hit.row, hit.direction_world);
    }
  }
}

}  // namespace dynamic_icp::tracking
