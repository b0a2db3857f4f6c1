// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::tracking {

/// An upright cylinder that moves during a scan, in the frame of its points.
struct SoughtPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, at the stamp
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();   ///< m/s
  double reach_m = 0.0;                              ///< in the plane of x and y
  double half_height_m = 0.0;
};

/// Bounds of up to 64 patches of a scan, 64 rows each. Rows that follow each other are seen near each other more often
/// than not: side by side, or one above the other with the ranges of a whole line of sight. So each patch has a box of
/// its own, whose first axis points from the sensor to its middle row.
class PatchBlock {
 public:
  static constexpr std::size_t kRows = 64;  ///< of a patch
  static constexpr std::size_t kPatches = 64;
  using Flags = std::array<std::uint8_t, kPatches>;

  /// Of the rows [begin, end) of a scan, at least one and at most kRows * kPatches, whose sensor turns with `turn_rps`:
  /// their points may be moved by that much from where they are. Deskewed ones are not: 0.
  void bound(const Scan& scan, std::size_t begin, std::size_t end, double turn_rps);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Which patches may have points there.
  void find(const SoughtPlace& place, Flags& may_hold) const;

 private:
  void bound_points(std::size_t patch, std::span<const Eigen::Vector3d> points);
  void bound_times(std::size_t patch, std::span<const double> times, double turn_rps);

  using Values = std::array<double, kPatches>;

  std::size_t count_ = 0;
  Values x_{}, y_{};                          ///< the first axis
  Values along_low_{}, along_high_{};         ///< m
  Values across_low_{}, across_high_{};       ///< m
  Values low_{}, high_{};                     ///< m, upward
  Values time_{}, half_time_{}, turned_m_{};  ///< middle and half of the times, s; how far the turn may move points
};

}  // namespace dynamic_icp::tracking
