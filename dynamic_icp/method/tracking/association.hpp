// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dynamic_icp/method/tracking/expectation.hpp"

namespace dynamic_icp::tracking {

/// The cell belongs to no track.
inline constexpr std::int32_t kNobody = -1;

/// The owner of each cell of a scan. May be used again, so that no memory is asked for.
struct CellOwners {
  std::vector<std::int32_t> owner;  ///< of each cell: number of an expectation, or kNobody

  // Memory of `associate`
  struct Link {
    std::int32_t owner = kNobody;
    std::int32_t next = kNobody;  ///< link to another owner of the same group
  };
  std::vector<double> best_ratio;        ///< of each cell
  std::vector<double> outside;           ///< m: of what was seen of the owner; 0 where it is well within the gate
  std::vector<std::int32_t> first_link;  ///< of each group, to its owners in the order of their first cells
  std::vector<std::int32_t> last_link;   ///< of each group
  std::vector<Link> links;
};

/// Gives each cell to the expectation whose box and velocity fit it best. Cells that are linked to those of one and not
/// farther than `growth_m` from its box become part of it: sides that come into view, unless what was seen of the one
/// that expects them there is nearer.
void associate(const TrackingInput& input, std::span<const Expectation> expectations, double growth_m,
               CellOwners& result);

}  // namespace dynamic_icp::tracking
