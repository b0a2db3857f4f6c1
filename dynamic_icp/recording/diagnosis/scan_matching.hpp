// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"

namespace dynamic_icp::diagnosis {

/// The pose of the later sensor in the axes of the earlier one, by the points alone.
///
/// Many starts along each axis (unit vectors) are tried and the best kept, point to plane. Nothing where that is not
/// beyond doubt: too few points meet, another start fits almost as well (a smooth tunnel, equal posts), or the way is
/// not held by the geometry. Scans that sweep are deskewed by the way found, which takes the share of the times in
/// `dt_s` but not their unit.
std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             std::span<const Eigen::Vector3d> axes, const Workers& workers);

/// The same from one start that is known to be near.
std::optional<Eigen::Isometry3d> match_scans(const Scan& earlier, const Scan& later, double dt_s,
                                             const Eigen::Isometry3d& T_start, const Workers& workers);

}  // namespace dynamic_icp::diagnosis
