// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/mapping/mapping_config.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"
#include "dynamic_icp/method/mapping/plane_sums.hpp"
#include "dynamic_icp/method/motion/rotation_filter.hpp"
#include "dynamic_icp/method/motion/sweep_motion.hpp"

namespace dynamic_icp::mapping {

/// What is known of a scan's motion before its points are compared with the map.
struct MotionPrior {
  Eigen::Matrix3d R_map_sensor = Eigen::Matrix3d::Identity();  ///< at the stamp
  motion::SweepMotion sweep;
  motion::Matrix9d covariance =
      motion::Matrix9d::Identity();  ///< of [rotation (rad, map axes); omega (rad/s); alpha (rad/s^2)]

  /// The position at the stamp from the Doppler velocities: t = displacement_fixed + R displacement_rotated. The second
  /// part comes from the velocity of this very scan, which turns with it.
  Eigen::Vector3d displacement_fixed = Eigen::Vector3d::Zero();          ///< m, map axes, from the map's origin
  Eigen::Vector3d displacement_rotated = Eigen::Vector3d::Zero();        ///< m, sensor axes at the stamp
  Eigen::Matrix3d translation_covariance = Eigen::Matrix3d::Identity();  ///< m^2, map axes
};

/// Where a scan stands in the map and how the sensor moved during it.
struct MapAlignment {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();  ///< at the stamp
  motion::SweepMotion sweep;
  /// Of [rotation (rad); position (m); omega; alpha], rotation about the sensor, all but the last two in map axes.
  Matrix12d covariance = Matrix12d::Identity();
  Matrix6d geometry_information = Matrix6d::Zero();  ///< what the points alone say of [rotation; position]
  bool converged = false;
  bool diverged = false;  ///< a step was not finite or left the reach of any scan; the rest is that of the step before
  int iterations = 0;
  std::size_t points = 0;     ///< of the scan
  std::size_t on_planes = 0;  ///< with a patch of the map
  double matched = 0.0;       ///< sum of the kernel's weights: points that agree
  double rms_m = 0.0;         ///< distance of those from their planes
  double chi = 0.0;           ///< the same over its predicted standard deviation: 1 where the noise model is right
  /// m, standard deviation of patches from planes: what the mean distances of the points on the patches scatter more
  /// than noise and the errors of the fits explain. Nothing when too few patches tell.
  std::optional<double> model_sigma_m;
};

/// Aligns a scan of static points to a map. Minimises over rotation, position, omega and alpha
///   sum_i w_i rho(e_i) + |prior|^2,   e_i = n . (T_map_sensor T_stamp_tau(i) p_i - mean)
/// by Gauss-Newton: point-to-plane distances at the time of each point, the displacement by the Doppler velocities of
/// this and earlier scans with their covariance, and the motion expected from the scans before. They share the work by
/// information alone. The points on one patch have its error c = height_variance + model_sigma^2 in common, so m
/// of them with a variance s^2 each weigh w_i = 1 / (s^2 + m c): together never more than 1 / c.
///
/// The kernel begins as wide as the prior is uncertain and narrows with each step; meanwhile a part of the points does.
/// Without point times (`scan.has_times()` false) the whole scan is taken at its stamp.
MapAlignment align_to_map(const Scan& scan, const PlaneMap& map, const MotionPrior& prior, const MapAlignConfig& config,
                          const Workers& workers);

/// The same from another rotation than the prior's, with a kernel that begins `gate_m` wide.
MapAlignment align_to_map(const Scan& scan, const PlaneMap& map, const MotionPrior& prior,
                          const Eigen::Matrix3d& R_start, double gate_m, const MapAlignConfig& config,
                          const Workers& workers);

/// What the points of an alignment say of the position that is no more than the noise of normals (1/m^2, map axes); to
/// be taken from `geometry_information` where that must not be believed too readily.
Eigen::Matrix3d position_information_of_noise(const Scan& scan, const PlaneMap& map, const MapAlignment& found,
                                              const MapAlignConfig& config, const Workers& workers);

/// What an alignment says of the rotation, its prior included.
motion::RotationState rotation_state(const MapAlignment& found);

}  // namespace dynamic_icp::mapping
