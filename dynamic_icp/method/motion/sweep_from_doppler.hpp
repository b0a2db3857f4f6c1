// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"

// Whether a scan was taken in an instant or in an order of its points, by its Doppler alone.
//
// A sensor that accelerates measures the first points of a sweep at another velocity than the last. How it accelerates
// is known from the velocities of the scans before and after, whatever the order of the points within a scan. With the
// place q_i of a point in an order, from -1/2 to 1/2, a sweep that takes D in this order measures
//   s_i = -u_i . (v_k + q_i (D a_k + c)) + b
// of the static points of scan k: a_k is the acceleration, v_k the velocity in the middle of the sweep, b the constant
// error of the Doppler, and c takes in constant errors that look like a change of velocity. D is zero for scans taken
// in an instant and negative for sweeps in the opposite order.
namespace dynamic_icp::motion {

/// Orders in which the points of a scan may have been measured.
enum class PointOrder {
  kAzimuth,   ///< the azimuth atan2(y, x) grows: from right to left, counter-clockwise as seen from above
  kAsStored,  ///< as the points are stored
};

/// All that the static points of one scan say: sums of products of the columns -u (3), 1, -u q by azimuth (3), -u q as
/// stored (3) and s.
struct SweepSums {
  using Matrix = Eigen::Matrix<double, 11, 11>;

  double time_s = 0.0;               ///< of the stamp, after any fixed time
  Matrix products = Matrix::Zero();  ///< symmetric
};

/// `scan` is made of `raw`, and `rows` are those of its points that are static. The places by azimuth are those of
/// `declared_times`.
SweepSums sweep_sums(const RawScan& raw, const Scan& scan, std::span<const std::uint32_t> rows, double time_s,
                     const Workers& workers);

/// How long sweeps take in an order.
struct SweepDuration {
  double duration_s = 0.0;                                   ///< D
  double sigma_s = std::numeric_limits<double>::infinity();  ///< its standard deviation; infinite: unobservable
  double explained = 0.0;  ///< how much better than an instant it explains the Doppler: difference of chi squared
};

/// D of some stretches of consecutive scans, one every `period_s` > 0 on average; stamps increase. The acceleration is
/// the derivative at the middle one of each five scans, so stretches of fewer say nothing, and so do scans beside a
/// gap: an interval longer than 1.6 times `period_s`. The standard deviation is the larger one of what the noise of the
/// points explains and of what the scatter from scan to scan shows.
SweepDuration sweep_duration(std::span<const std::vector<SweepSums>> stretches, PointOrder order, double period_s);

}  // namespace dynamic_icp::motion
