// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/recording/datasets/correction.hpp"

namespace dynamic_icp::diagnosis {

/// Factors that bring numbers into the order of metres and metres per second.
struct UnitGuess {
  double points = 1.0;
  double doppler = 1.0;
};

/// Which of the columns of coordinates are azimuth, elevation and range.
struct SphericalColumns {
  std::array<int, 3> columns = {0, 1, 2};
  datasets::Coordinates coordinates = datasets::Coordinates::kSphericalDegrees;
  double residual = 0.0;  ///< m/s, as those of ColumnScores
};

/// How well each of the four columns is explained as the Doppler of a static scene whose points are the other three.
struct ColumnScores {
  /// m/s, |s + u.v| of the points, 30 % are below, median over the scans: of what is static even in traffic. What is
  /// a Doppler scatters by centimetres per second, moving or standing, with the sensor's motion in it or not; a
  /// coordinate scatters by metres.
  std::array<double, 4> residual = {0.0, 0.0, 0.0, 0.0};
  int doppler = 3;         ///< the column that is the Doppler beyond doubt, else the last one
  int likely_doppler = 3;  ///< the one that is explained much better than the last one, if not well; else the last one

  /// The spherical coordinates that explain the last column best, where the numbers may be such ones.
  std::optional<SphericalColumns> likely_spherical = std::nullopt;

  /// Angles with ranges of surfaces (range_surfaces.hpp), in degrees some of which are beyond 2 pi, or in radians that
  /// can be no metres: what the Doppler of a sensor at rest does not tell.
  std::optional<SphericalColumns> surfaces = std::nullopt;

  /// Spherical coordinates beyond doubt: a velocity explains the last column well with these and not with the
  /// coordinates as they are.
  std::optional<SphericalColumns> spherical = std::nullopt;
};

/// From the largest coordinates and Doppler of some scans. Nobody measures points beyond a kilometre by LiDAR, or
/// Doppler beyond 150 m/s on the road: those are millimetres, centimetres per second or the like.
UnitGuess guess_units(std::span<const RawScan> scans);

ColumnScores score_columns(std::span<const RawScan> scans, const Workers& workers);

/// The scan with column `doppler` as its Doppler, the others in their order, and in guessed units. Lines of sight of
/// its own are kept only where the columns are.
RawScan prepared(RawScan scan, int doppler, const UnitGuess& units);

/// The same by what was found of the columns, from spherical coordinates too.
RawScan prepared(RawScan scan, const ColumnScores& scores, const UnitGuess& units);

/// The order in which `prepared` takes the columns.
std::array<int, 4> with_doppler_last(int doppler);

}  // namespace dynamic_icp::diagnosis
