// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"
#include "dynamic_icp/recording/diagnosis/sensor_look.hpp"

namespace dynamic_icp::diagnosis {

/// Share of the values that are called nearly all: a few strays say nothing of a unit.
inline constexpr double kNearlyAll = 0.95;

/// A point whose Doppler differs by less from what a velocity explains fits to it.
inline constexpr double kFitting_mps = 0.5;

/// The Doppler of the usable points of a scan.
struct DopplerValues {
  std::size_t count = 0;
  std::size_t negative = 0;
  std::size_t positive = 0;  ///< the others are exactly zero
  double median = 0.0;
  double scatter = 0.0;       ///< median absolute deviation from the median
  double scatter_left = 0.0;  ///< the same after the velocity of the sensor was taken out
};

/// What the Doppler of a scan shows by itself.
struct DopplerFit {
  ego_motion::EgoVelocity ego;             ///< with its bias
  double static_share = 0.0;               ///< of the points that fit to this velocity within 0.5 m/s
  std::vector<double> residuals;           ///< m/s, of each point
  std::vector<std::uint32_t> static_rows;  ///< points that fit within the noise

  /// Whether the velocity is one: enough points agree and all directions are known.
  [[nodiscard]] bool has_velocity() const;
};

DopplerFit fit_doppler(const Scan& scan, const Workers& workers);

/// What one scan shows by itself.
struct ScanLook {
  Stamp stamp;
  std::size_t points = 0;
  Scan::Dropped dropped;
  bool has_times = false;
  double first_time_s = 0.0;  ///< of the finite ones
  double last_time_s = 0.0;
  double far_m = 0.0;     ///< 95 % of the points are nearer
  double fast_mps = 0.0;  ///< 95 % of the Doppler are slower
  DopplerValues values;
  Eigen::Vector3d look_direction = Eigen::Vector3d::Zero();  ///< mean line of sight
  Eigen::Vector3d look_spread = Eigen::Vector3d::Zero();     ///< root mean square of each axis of the lines of sight
  ego_motion::EgoVelocity ego;                               ///< see DopplerFit
  double static_share = 0.0;

  std::vector<Eigen::Isometry3d> mountings;  ///< of a rig: T_scan_sensor
  std::vector<SensorLook> sensors;           ///< of a rig with relative Doppler, in the order of the mountings

  [[nodiscard]] bool has_velocity() const;
};

/// Looks at a scan; `still` takes its points that fit to the velocity, or all of them where no velocity fits.
ScanLook look_at(const RawScan& raw, const Workers& workers, Scan* still = nullptr);

/// Median absolute deviation from the median; 0 of none.
double scatter_of(std::vector<double> values);

/// Standard error of the median of independent values, by their scatter; 0 of none.
double median_error(const std::vector<double>& values);

}  // namespace dynamic_icp::diagnosis
