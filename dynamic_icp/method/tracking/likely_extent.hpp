// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>

#include "dynamic_icp/method/tracking/room.hpp"
#include "dynamic_icp/method/tracking/vehicle_sizes.hpp"

namespace dynamic_icp::tracking {

/// How far a box was seen along one of its axes, from its reference: m, both ways outwards.
struct SeenExtent {
  double high = 0.0;
  double low = 0.0;
  bool ends_high = false;  ///< the body ends there; else it reaches at least so far
  bool ends_low = false;
  bool is_cut_high = false;  ///< by the edge of the field of view
  // m: the body does not reach farther than that beyond an end that was not seen, as something else is there
  double room_high = kUnlimited_m;
  double room_low = kUnlimited_m;

  [[nodiscard]] double length() const { return std::max(0.0, high + low); }
  [[nodiscard]] bool is_whole() const { return ends_high && ends_low; }
};

/// The extent of the body along one axis.
struct LikelyExtent {
  double size = 0.0;    ///< m
  double middle = 0.0;  ///< m, from the reference
  // The middle is `weight_high` of the distance of the high end minus `weight_low` of that of the low one, and more
  // that they do not tell.
  double weight_high = 0.0;
  double weight_low = 0.0;
  double variance = 0.0;  ///< of that, m^2
};

/// Of a body along, to the left and up, with what was not seen filled in by what is likely: of vehicles that are like
/// others that were seen whole (`sizes`), or else of any (size_prior). Where neither of its sides was seen from end to
/// end, the highest point seen may be that of a hood; what the upper edge of the field of view cuts off may be as high
/// as vehicles are. Nothing is guessed of a person, and of a body without heading only that there may be more.
std::array<LikelyExtent, 3> likely_extents(const std::array<SeenExtent, 3>& seen, bool has_heading, bool may_be_person,
                                           const VehicleSizes& sizes = {});

}  // namespace dynamic_icp::tracking
