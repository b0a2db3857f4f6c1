// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// What a positive Doppler means, as stored.
enum class DopplerSign { kAway, kTowards };

/// What the three coordinates of a point are, as stored. Of the spherical ones the azimuth counts from x ahead towards
/// y on the left, the elevation upwards from the plane of both; the range is in the unit of x, y and z.
enum class Coordinates { kCartesian, kSphericalDegrees, kSphericalRadians };

/// How the numbers of a recording are corrected where it, or its layout, states them wrong: what the diagnosis proposes
/// and a user may state. What is not set is taken as the recording and its layout have it.
struct Correction {
  static constexpr std::array<int, 4> kInOrder = {0, 1, 2, 3};

  std::optional<DopplerKind> doppler_kind = {};
  std::optional<DopplerSign> doppler_sign = {};
  std::optional<double> doppler_scale = {};        ///< factor of the Doppler: 0.001 for mm/s
  std::optional<double> point_scale = {};          ///< factor of x, y, z: 0.001 for mm
  std::optional<double> time_scale = {};           ///< of the time since the first scan, and of the times of points
  std::optional<std::array<int, 4>> columns = {};  ///< which of the columns as read are x, y, z and Doppler
  std::optional<Coordinates> coordinates = {};     ///< spherical: azimuth, elevation, range in place of x, y, z

  bool operator==(const Correction&) const = default;

  /// Takes over what the other one sets.
  void apply(const Correction& other);
};

/// Throws UsageError for scales that are not positive and finite, and for columns that are no permutation of 0..3.
void check(const Correction& correction);

/// One scan corrected: points, lines of sight, Doppler, times of points and the kind; not its stamp. Mountings are in
/// the unit and the axes of the points: positions are scaled, axes of scan and sensor change places. Lines of sight and
/// mountings are dropped where the Doppler changes places with a coordinate, or where the coordinates are spherical:
/// the points were put together of the wrong columns.
RawScan corrected(RawScan scan, const Correction& correction);

/// The recording with its numbers corrected on the way out. Ground truth is left as it is, but where all its stamps are
/// those of scans they came from the same clock and move with them. Throws UsageError as `check` does, and DataError
/// that names the scan where the scaled time is beyond what a stamp holds.
std::unique_ptr<Dataset> corrected(std::unique_ptr<Dataset> dataset, const Correction& correction);

}  // namespace dynamic_icp::datasets
