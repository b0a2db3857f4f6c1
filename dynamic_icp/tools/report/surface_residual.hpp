// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/registration/target.hpp"

namespace dynamic_icp::report {

/// The surface that the points of a scan (m) lie on: a plane through each of them, thinned, fitted to its neighbours.
registration::PreparedTarget surface_of(std::span<const Eigen::Vector3d> points, const Workers& workers);

/// Distance (m) of each point, moved by `T_surface_point`, to the plane through the nearest point of the surface,
/// |n . (p - q)|; NaN where there is none within 1 m or where its neighbours are no plane.
std::vector<double> surface_residual(const registration::PreparedTarget& surface,
                                     std::span<const Eigen::Vector3d> points, const Eigen::Isometry3d& T_surface_point,
                                     const Workers& workers);

}  // namespace dynamic_icp::report
