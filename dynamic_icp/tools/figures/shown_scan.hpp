// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::figures {

// What a point is, as the page says it.
inline constexpr std::uint8_t kNotUsed = 0;
inline constexpr std::uint8_t kStatic = 1;
inline constexpr std::uint8_t kDynamic = 2;      ///< moves, but belongs to no object
inline constexpr std::uint8_t kFirstObject = 3;  ///< and on: the objects of the frame in their order

/// Points farther from the sensor are not shown: one stray return must not take the resolution from all others.
inline constexpr double kFarthestShown_m = 1000.0;

/// Faster over ground, a point (by its compensated Doppler) or an object is shown as moving.
inline constexpr double kMoving_mps = 0.5;

/// A scan as the page shows it: columns of equal length.
struct ShownScan {
  std::vector<Eigen::Vector3d> points;  ///< m, sensor frame at the stamp; deskewed where the run was,
                                        ///< for points on objects their motion during the sweep as well
  std::vector<double> doppler;          ///< m/s as measured, positive away
  std::vector<double> compensated;      ///< m/s, what is left without the own motion; NaN: unknown
  std::vector<std::uint8_t> labels;
  std::vector<double> residual;  ///< m, distance to the surface of the previous scan; NaN: no surface near

  [[nodiscard]] std::size_t size() const { return points.size(); }
};

/// The rows named by `rows`, in that order.
ShownScan select(const ShownScan& scan, std::span<const std::uint32_t> rows);

/// A scan as read by `read_scan`, with what the run says of it. The residuals are still unknown. Labels come
/// from labels/*.bin or, where the run did not write them, from the objects and the compensated Doppler: then every
/// point counts as used; where the method does not tell moving points from static ones, as static. Throws DataError
/// when the labels do not fit the scan.
ShownScan show_scan(const runs::RunFiles& run, std::size_t frame, const RawScan& raw, const Workers& workers);

}  // namespace dynamic_icp::figures
