// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/registration/align_config.hpp"
#include "dynamic_icp/method/registration/correspondences.hpp"
#include "dynamic_icp/method/registration/linearisation.hpp"
#include "dynamic_icp/method/registration/sensor_velocity.hpp"

namespace dynamic_icp::registration {

enum class DopplerTerm {
  kNone,
  kRotation,       ///< the paper's, Eq. (13)
  kSensorVelocity  ///< of Doppler-ICP
};

/// What a method minimises: terms, weights, kernels and rejection rules.
///   (1 - lambda) sum loss_g(e_g) + lambda sum loss_D(e_D)
struct Objective {
  GeometryTerm geometry = GeometryTerm::kPointToPlane;
  DopplerTerm doppler = DopplerTerm::kRotation;
  Gate gate;                             ///< points farther apart make no pair
  double doppler_weight = 0.2;           ///< lambda; 0 leaves the Doppler term out
  double tukey_geometry_m = 0.5;         ///< beyond this no weight; infinity: least squares
  double tukey_doppler_mps = 0.3;        ///< likewise
  int tukey_doppler_from_iteration = 0;  ///< before (counted from 0) the Doppler term is least squares
  double thickness = 1e-3;               ///< of planes, see plane_to_plane.hpp
  VehicleMotion vehicle;                 ///< for kSensorVelocity
  /// Pairs whose Doppler residual is larger have no weight in either term, from this iteration (from 0) on.
  double reject_doppler_mps = std::numeric_limits<double>::infinity();
  int reject_from_iteration = 2;
};

/// Whether the Doppler takes part at all.
inline bool has_doppler(const Objective& objective) {
  return objective.doppler != DopplerTerm::kNone && objective.doppler_weight > 0.0;
}

/// The scan that is moved.
struct Source {
  const Scan& scan;
  std::span<const Eigen::Vector3d> normals = {};  ///< for kPlaneToPlane only
  std::span<const std::uint8_t> has_normal = {};  ///< 1 where the normal may be used
};

/// Two scans and which of their points belong together. It only refers to its parts; they must outlive it.
struct PairedScans {
  const Source& source;
  const Target& target;
  const Correspondences& correspondences;
};

/// Sums weights, residuals and Jacobians of both terms over the correspondences at T_target_source, for any objective;
/// `iteration` counts from 0.
Linearisation linearise(const PairedScans& scans, const Eigen::Isometry3d& T_target_source, const Objective& objective,
                        int iteration, const Workers& workers);

}  // namespace dynamic_icp::registration
