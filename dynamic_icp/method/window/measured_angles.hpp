// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::window {

/// How a point moves with the azimuth and the elevation that its sensor measured: d(point)/d[azimuth; elevation],
/// m/rad, axes of the scan.
Eigen::Matrix<double, 3, 2> by_angles(const Scan& scan, std::size_t row);

}  // namespace dynamic_icp::window
