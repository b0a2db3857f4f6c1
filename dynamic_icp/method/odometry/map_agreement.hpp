// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

// What preset `default` asks of an alignment with its map.
namespace dynamic_icp::odometry {

/// Fewer agree with a map only by chance: of the points on its patches, and of all. A sparse radar meets few patches in
/// the map of one scan (2 % of its points agree), and fits those well.
inline constexpr double kMinAgreement = 0.2;
inline constexpr double kMinMatch = 0.01;

/// The usual share of points that agree with the map follows the last scans with this weight for the newest.
inline constexpr double kUsualMatchGain = 0.2;

}  // namespace dynamic_icp::odometry
