// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/registration/correspondences.hpp"

namespace dynamic_icp::registration {

/// A motion between two scans of which nothing was known, and how badly it fits.
struct WayCandidate {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  double cost = 1.0;  ///< see `misfit`
};

/// Of the source points, how far they are from the planes of the target: 0 when all lie on one, 1 when none is near.
double misfit(const Scan& source, const Target& target, const Eigen::Isometry3d& T_target_source,
              const Workers& workers);

/// Aligns a part of the source, point to plane, from starts every 0.8 m up to `reach_m` along each axis (unit vectors)
/// and against it. Candidates in the order of the starts; several may be the same motion.
std::vector<WayCandidate> search_ways(const Scan& source, const Target& target, std::span<const Eigen::Vector3d> axes,
                                      double reach_m, const Workers& workers);

/// The one that fits best; there must be one.
const WayCandidate& best_way(const std::vector<WayCandidate>& candidates);

/// Whether no other way fits nearly as well: false in smooth tunnels and between equal posts.
bool is_clear(const std::vector<WayCandidate>& candidates);

/// At most so many rows, evenly over the scan.
Scan evenly_thinned(const Scan& scan, std::size_t most);

}  // namespace dynamic_icp::registration
