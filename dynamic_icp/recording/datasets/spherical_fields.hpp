// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::datasets {

enum class AngleUnit : std::uint8_t { kDegrees, kRadians };

/// How the columns of a point that are azimuth, elevation and range say it. The azimuth counts from x ahead towards y
/// on the left, the elevation upwards.
struct SphericalFields {
  std::optional<AngleUnit> unit = {};  ///< of both angles; nothing: no name says it
  bool from_zenith = false;            ///< the second angle counts from z downwards
  bool is_theta_phi = false;           ///< theta and phi, in this order: no name says which of them is the azimuth
};

/// x, y, z of a point in that direction, in the unit of the range.
Eigen::Vector3d from_spherical(double azimuth_rad, double elevation_rad, double range);

/// Makes azimuth, elevation (or angle from z) and range cartesian. The unit must be known.
void make_cartesian(std::vector<Eigen::Vector3d>& points, const SphericalFields& fields);

/// Settles by the points of a scan, as stored, what the names of their columns leave open: angles beyond a turn in
/// radians are degrees; of theta and phi the azimuth is the one that spans more by far, and the other is an elevation
/// where some are negative, and an angle from z where all are far from it. The names are put in the order azimuth,
/// other angle, range: their columns are to follow. Returns what was found, a sentence.
///
/// Throws UnclearInput with what may be meant where the numbers do not tell it. `origin` stands for the file in
/// messages.
std::string settle(SphericalFields& fields, std::array<std::string, 3>& names,
                   const std::vector<Eigen::Vector3d>& points, const std::string& origin);

}  // namespace dynamic_icp::datasets
