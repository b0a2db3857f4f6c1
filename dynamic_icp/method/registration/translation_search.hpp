// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/registration/target.hpp"

namespace dynamic_icp::registration {

/// Where an initial translation is looked for.
struct TranslationSearch {
  /// Unit vectors, target axes; along each and against it.
  std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  // As far as a vehicle drives between the scans, but within these bounds.
  double min_reach_m = 0.8;
  double max_reach_m = 10.0;
};

/// A motion between two scans of which nothing was known.
struct InitialTranslation {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  double cost = 1.0;  ///< see `misfit`
  bool is_unambiguous =
      false;  ///< no other motion fits nearly as well: false in smooth tunnels and between equal posts
};

/// Aligns a part of the source, point to plane, from starts every 0.8 m along each axis; the motion that fits best.
/// `dt_s` lies between the scans.
InitialTranslation search_translation(const Scan& source, const Target& target, double dt_s,
                                      const TranslationSearch& search, const Workers& workers);

/// The scan thinned and prepared to be the target of such a search.
PreparedTarget search_target(const Scan& scan, const Workers& workers);

/// How far the source points are from the planes of the target: 0 when all lie on one, 1 when none is near.
double misfit(const Scan& source, const Target& target, const Eigen::Isometry3d& T_target_source,
              const Workers& workers);

/// At most so many rows, evenly over the scan.
Scan evenly_thinned(const Scan& scan, std::size_t most);

}  // namespace dynamic_icp::registration
