// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>

#include "dynamic_icp/method/base/raw_scan.hpp"

// What a measurement may be. `Scan` keeps what lies within these limits and counts the rest as implausible, so that no
// later stage has to guard its squares, products and conversions to integers. They are far beyond any sensor: what
// exceeds them is damage, not a measurement.
namespace dynamic_icp {

inline constexpr double kMaxCoordinate_m = 1e5;   ///< of a point, per axis: 100 km
inline constexpr double kMaxDoppler_mps = 1e4;    ///< faster than a satellite in orbit
inline constexpr double kMaxPointTime_s = 100.0;  ///< of a point, before or after the stamp of its scan

inline constexpr std::size_t kMaxSensors = 256;  ///< of a rig: Channels::sensor

inline constexpr double kMaxAcceleration_mps2 = 1e4;  ///< of the sensor: a thousand times gravity

/// Scans that follow each other faster tell no velocity: a motion of a millimetre would be one of metres per second.
inline constexpr double kMinScanInterval_s = 1e-3;

/// A motion is predicted so far ahead and no farther; beyond, the sensor is taken to have stopped.
inline constexpr double kMaxPrediction_s = 60.0;

/// The times of points, s after the stamp, that can belong to one scan. Both ends belong to it.
struct TimeWindow {
  double min_s = -std::numeric_limits<double>::infinity();
  double max_s = std::numeric_limits<double>::infinity();

  /// False for NaN.
  [[nodiscard]] bool contains(double time_s) const { return time_s >= min_s && time_s <= max_s; }
};

/// The window that holds the middle nine tenths of the times, and on either side as much again, at least 0.1 s: wide
/// enough for points that crowd in a part of the scan, too narrow for a damaged time to change the duration of the scan
/// much. It is found from at most 2,000 of the times; those that are not finite or beyond kMaxPointTime_s do not count.
TimeWindow plausible_times(const Column& times_s);

}  // namespace dynamic_icp
