// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

/// A place that moves during a scan, in the frame of its points: a rectangle in the plane of x and y, everything within
/// a reach of it, and so much above and below. Without a rectangle it is an upright cylinder.
struct SoughtPlace {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, at the stamp
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector2d half_length =
      Eigen::Vector2d::Zero();  ///< m, from the centre of the rectangle to the middle of a side
  Eigen::Vector2d half_width = Eigen::Vector2d::Zero();  ///< m, the same of the next side
  double reach_m = 0.0;
  double half_height_m = 0.0;
  /// How fast the sensor turns, rad/s: points may be moved by that much from where they are. Deskewed ones are not: 0.
  double turn_rps = 0.0;
};

/// The place of a box that moves with `drift` (m/s) in its frame, while the sensor turns with `turn_rps` (rad/s).
SoughtPlace place_of(const OrientedBox& box, const Eigen::Vector3d& drift, double turn_rps);

/// Bounds of up to 64 patches of a scan, 128 rows each. Rows that follow each other are seen near each other more often
/// than not: side by side, or one above the other with the ranges of a whole line of sight. So each patch has a box of
/// its own, whose first axis points from the sensor to its middle row.
class PatchBlock {
 public:
  static constexpr std::size_t kRows = 128;  ///< of a patch
  static constexpr std::size_t kPatches = 64;
  static constexpr std::size_t kBlock = kRows * kPatches;  ///< rows
  using Flags = std::array<std::uint8_t, kPatches>;

  /// Of at least one and at most kBlock rows: their points and the times of these, none where they have none.
  void bound(std::span<const Eigen::Vector3d> points, std::span<const double> times);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Which patches may have points there.
  void find(const SoughtPlace& place, Flags& may_hold) const;

  using Values = std::array<double, kPatches>;

  /// The box of each patch: its first axis, at a right angle the second, and upward the third.
  struct Bounds {
    Values x{}, y{};                     ///< the first axis
    Values along_low{}, along_high{};    ///< m
    Values across_low{}, across_high{};  ///< m
    Values low{}, high{};                ///< m, upward
  };
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }

 private:
  void bound_points(std::size_t patch, std::span<const Eigen::Vector3d> points);
  void bound_times(std::size_t patch, std::span<const double> times);

  std::size_t count_ = 0;
  Bounds bounds_;
  Values time_{}, half_time_{};   ///< middle and half of the times, s
  Values latest_{}, farthest_{};  ///< s from the stamp; m from the sensor
};

/// Those of a whole scan, to be asked more than once.
class ScanPatches {
 public:
  /// In the memory of another scan.
  void bound(const Scan& scan, const Workers& workers);

  /// Of the lines of sight, as if each point was one metre away.
  void bound_sights(const Scan& scan, const Workers& workers);

  [[nodiscard]] std::span<const PatchBlock> blocks() const { return blocks_; }

  /// Calls visit(begin, end) for the rows [begin, end) of each patch that may have points in a place, ascending.
  template <typename Visit>
  void visit(const SoughtPlace& place, const Visit& visit) const {
    std::size_t block_begin = 0;
    for (const PatchBlock& patches : blocks_) {
      PatchBlock::Flags may_hold;
      patches.find(place, may_hold);
      visit_flagged(may_hold, 0, patches.count(), [&](std::size_t patch) {
        const std::size_t begin = block_begin + patch * PatchBlock::kRows;
        visit(begin, std::min(begin + PatchBlock::kRows, rows_));
      });
      block_begin += PatchBlock::kBlock;
    }
  }

 private:
  void bound(std::span<const Eigen::Vector3d> points, std::span<const double> times, const Workers& workers);

  std::size_t rows_ = 0;
  std::vector<PatchBlock> blocks_;
};

/// Clears `is_moving` of the rows whose points are nearer to their sensor than `range_m`, in a scan that is not
/// deskewed. `patches`: of the scan.
void clear_near_rows(const Scan& scan, const ScanPatches& patches, double range_m,
                     std::vector<std::uint8_t>& is_moving);

}  // namespace dynamic_icp::tracking
