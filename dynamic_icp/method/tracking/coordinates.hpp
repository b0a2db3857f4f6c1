// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/oriented_box.hpp"

namespace dynamic_icp::tracking {

/// The coordinates of the points of a small block, each in an array of its own: loops over them become vectors.
struct Coordinates {
  static constexpr std::size_t kMaxPoints = 512;
  std::array<double, kMaxPoints> x;
  std::array<double, kMaxPoints> y;
  std::array<double, kMaxPoints> z;

  /// Those of `count` points, at most kMaxPoints.
  void take(const Eigen::Vector3d* points, std::size_t count);
};

/// The interval around some values, at least one.
[[nodiscard]] Interval interval_around(std::span<const double> values);

}  // namespace dynamic_icp::tracking
