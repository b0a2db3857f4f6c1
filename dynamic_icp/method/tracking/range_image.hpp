// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/lazy_image.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {

/// How far one sees in each direction: the range of the nearest point in cells of about half a degree by one degree.
/// Tells the true end of a body from the place where something nearer begins to hide it.
///
/// Made for bodies on the ground around the sensor: what is seen more than 46 degrees above or below its horizontal
/// plane shares the outermost cells, and the edge of the field of view is known sideways and as the lowest and the
/// highest that was seen anywhere.
///
/// Questions may come from several threads; the answers are the same in any order.
class RangeImage {
 public:
  /// Where nothing is seen.
  RangeImage() = default;

  /// From a deskewed scan, as it was measured: `velocity_sensor` (m/s) is that of the sensor.
  RangeImage(const Scan& scan, const Eigen::Vector3d& velocity_sensor, const Workers& workers);

  /// The same in the memory of another scan. Points are drawn when somebody asks about their directions: few are, so
  /// the scan and its patches must stay as they are until the last question. `patches`: of its points, or, of a scan
  /// with times, of anything that lies in the directions in which they were measured.
  void show(const Scan& scan, const ScanPatches& patches, const Eigen::Vector3d& velocity_sensor);

  /// Whether what is at `point` (m, sensor frame when that direction was measured) is hidden, or would be: something at
  /// least `clearance_m` nearer is seen in its direction, or nothing is seen above and below it either, or nowhere so
  /// low, as beyond the edge of the field of view. A negative clearance: also by what is so much farther away.
  [[nodiscard]] bool hides(const Eigen::Vector3d& point, double clearance_m) const;

  /// Whether anything is seen on the way from one place to another (m, sensor frame), or up to `higher_m` above it.
  [[nodiscard]] bool sees_along(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double higher_m) const;

  /// Whether nothing in the whole scan is seen as high as `point` (m, sensor frame): it may be above the field of view.
  [[nodiscard]] bool is_above_all(const Eigen::Vector3d& point) const;

  /// Removes those of the rows of the scan that seem to be seen through something nearer, as mirror images are: they
  /// lie behind what is seen in their directions and all around, and beside none of the others. Where most lie behind,
  /// all go if they are few beside what is nearer; else all stay, as what is seen through a fence or leaves. `rows`:
  /// ascending.
  void remove_mirrored(std::vector<std::uint32_t>& rows, std::vector<std::uint32_t>& memory) const;

  /// Width of a cell at a distance of one metre, m: what is closer together may share one.
  static double cell_width();

 private:
  std::unique_ptr<LazyImage> image_;  ///< none: nothing is seen

  [[nodiscard]] bool is_in_view(int column) const;
  [[nodiscard]] bool is_behind(std::uint32_t row) const;
  [[nodiscard]] bool are_beside(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool are_few(std::span<const std::uint32_t> rows) const;
};

}  // namespace dynamic_icp::tracking
