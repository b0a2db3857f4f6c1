// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

/// No body is so long.
constexpr double kUnlimited_m = 1000.0;

/// How much farther a body may reach than it was seen to, m: no two are in one place.
struct Room {
  double ahead = kUnlimited_m;
  double behind = kUnlimited_m;
};

/// What another body leaves of it, if that is in the same lane and goes the same way or the other. `likely`: as wide as
/// the body is in all likelihood; what was seen of it and of the other one ends along the lane.
Room room_beside(const OrientedBox& seen, const OrientedBox& likely, const OrientedBox& other);

}  // namespace dynamic_icp::tracking
