// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::registration {

/// Gate and stopping rule of an alignment of two scans, whatever it minimises.
struct MatchingConfig {
  double max_correspondence_distance_m = 0.3;
  int max_iterations = 100;
  double tolerance = 1e-5;  ///< on the change of fitness and of inlier RMSE (m)
  int min_correspondences = 6;
  double rank_tolerance = 1e-12;
};

/// With the weights and kernels of the paper's objective.
struct AlignConfig : MatchingConfig {
  double doppler_weight = 0.2;     ///< lambda_v; 0 leaves the Doppler term out (ablation "w/o DR")
  double tukey_geometry_m = 0.5;   ///< rho_g
  double tukey_doppler_mps = 0.3;  ///< rho_v
  /// The paper's "distance-aware correspondence threshold": a source point d metres from the sensor has a partner up to
  /// max_correspondence_distance_m + correspondence_range_scale * d away. The published value is 0.
  double correspondence_range_scale = 0.0;
};

ConfigFields fields(MatchingConfig& config);
ConfigFields fields(AlignConfig& config);

/// What an alignment of two scans minimises between their points.
enum class GeometryTerm {
  kPointToPoint,
  kPointToPlane,  ///< needs the target's normals
  kPlaneToPlane   ///< Generalized ICP: uses the normals of both
};

}  // namespace dynamic_icp::registration
