// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "dynamic_icp/method/base/lanes.hpp"

namespace dynamic_icp::registration {

/// Four points of a source scan each with all that an iteration reads of it and of its partner, so that an iteration
/// runs through one array from beginning to end. Coordinates come as x, y, z of four points; m.
struct SourceRows {
  using Numbers = std::array<double, simd::kLanes>;
  using Vectors = std::array<Numbers, 3>;

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // As measured, source frame. Zero in lanes beyond the last point of the scan.
  Vectors point{};
  Vectors ray{};  ///< Doppler times line of sight, m/s

  // In the target frame.
  Vectors moved{};             ///< at the pose asked for last
  Numbers squared_distance{};  ///< m^2, from there to the partner
  Vectors at{};                ///< where the point was looked up
  Numbers squared_validity{};  ///< m^2, moved less than this from there, it has the same partner; < 0: not looked up
  Numbers squared_gate{};      ///< m^2, the pair counts up to this distance; < 0: it never does
  Vectors target{};            ///< the partner, its normal, line of sight and Doppler; zero where there is none
  Vectors normal{};
  Vectors direction{};
  Numbers doppler{};                                  ///< m/s
  std::array<std::uint32_t, simd::kLanes> partner{};  ///< row of the target or kNone
};

}  // namespace dynamic_icp::registration
