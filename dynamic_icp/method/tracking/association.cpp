// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/association.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

/// Gives each cell to the expectation whose box and velocity fit it best.
void assign(const TrackingInput& input, std::span<const Expectation> expectations, CellOwners& result) {
  std::vector<std::int32_t>& owner = result.owner;
  refill(owner, input.moving.cells.size(), kNobody);
  refill(result.best_ratio, owner.size(), 1.0);
  refill(result.outside, owner.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < expectations.size(); ++k) {
    const Expectation& expected = expectations[k];
    const double reach =
        std::max(0.5 * expected.box.size.norm() + expected.gate_m,
                 (expected.whole.centre - expected.box.centre).norm() + 0.5 * expected.whole.size.norm());
    for (std::size_t i = 0; i < owner.size(); ++i) {
      const MovingCell& cell = input.moving.cells[i];
      const Eigen::Vector3d& point = input.cell_points[i];
      if ((point - cell.time_s * expected.velocity - expected.box.centre).squaredNorm() > reach * reach) {
        continue;
      }
      const double distance_ratio = expected.distance_ratio(point, cell.time_s);
      const double ratio = std::max(distance_ratio, expected.gate_ratio(input.cell_directions[i], cell.radial_mps));
      if (ratio < result.best_ratio[i] && expected.width_with(point, cell.time_s) < expected.max_width_m) {
        result.best_ratio[i] = ratio;
        owner[i] = static_cast<std::int32_t>(k);
        result.outside[i] = distance_ratio < kUnseenRatio ? 0.0 : expected.outside(point, cell.time_s);
      }
    }
  }
}

/// Links each group to the owners of its cells.
void link_owners(std::span<const std::uint32_t> groups, CellOwners& result) {
  const std::size_t count = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + std::size_t{1};
  refill(result.first_link, count, kNobody);
  refill(result.last_link, count, kNobody);
  result.links.clear();
  make_room(result.links, groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::int32_t owner = result.owner[i];
    std::int32_t link = result.first_link[groups[i]];
    while (link != kNobody && result.links[static_cast<std::size_t>(link)].owner != owner) {
      link = result.links[static_cast<std::size_t>(link)].next;
    }
    if (owner == kNobody || link != kNobody) {
      continue;
    }
    const auto added = static_cast<std::int32_t>(result.links.size());
    result.links.push_back({owner, kNobody});
    std::int32_t& last = result.last_link[groups[i]];
    (last == kNobody ? result.first_link[groups[i]] : result.links[static_cast<std::size_t>(last)].next) = added;
    last = added;
  }
}

}  // namespace

void associate(const TrackingInput& input, std::span<const Expectation> expectations, double growth_m,
               CellOwners& result) {
  assign(input, expectations, result);
  link_owners(input.groups, result);
  for (std::size_t i = 0; i < result.owner.size(); ++i) {
    const MovingCell& cell = input.moving.cells[i];
    double nearest = std::min(growth_m, result.outside[i]);
    for (std::int32_t link = result.first_link[input.groups[i]]; link != kNobody;
         link = result.links[static_cast<std::size_t>(link)].next) {
      const std::int32_t k = result.links[static_cast<std::size_t>(link)].owner;
      const Expectation& expected = expectations[static_cast<std::size_t>(k)];
      const double outside = expected.outside(input.cell_points[i], cell.time_s);
      if (outside < nearest && expected.gate_ratio(input.cell_directions[i], cell.radial_mps) < 2.0 &&
          expected.width_with(input.cell_points[i], cell.time_s) < expected.max_width_m) {
        nearest = outside;
        result.owner[i] = k;
      }
    }
  }
}

}  // namespace dynamic_icp::tracking
