// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <Eigen/Core>

namespace dynamic_icp::diagnosis {

/// Whether azimuths and elevations in degrees, with ranges, are directions in which surfaces are seen: points that are
/// less than a degree apart are at about the same range. What is none of it has many ranges there: taken for a range,
/// x is all from near to far where y and z are those of the ground. False where so few points lie close to each other
/// that it does not show.
bool shows_surfaces(std::span<const Eigen::Vector3d> azimuth_elevation_range);

/// Whether they are none beyond doubt: points that are less than a degree apart are at many ranges.
bool contradicts_surfaces(std::span<const Eigen::Vector3d> azimuth_elevation_range);

/// Whether columns that may be azimuths and elevations in radians, with ranges, are such ones and not coordinates in
/// metres: taken for angles they show surfaces, taken for x, y, z (`as_stored`) they show none, and they reach farther
/// than 20. What a sensor sees from one place has about one range in each direction, whatever there is to be seen:
/// coordinates speak for themselves even where they fill a slab as narrow as angles do. False where either reading has
/// too few points close to each other.
bool are_radians_with_ranges(std::span<const Eigen::Vector3d> azimuth_elevation_range,
                             std::span<const Eigen::Vector3d> as_stored);

}  // namespace dynamic_icp::diagnosis
