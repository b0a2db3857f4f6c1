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

}  // namespace dynamic_icp::diagnosis
