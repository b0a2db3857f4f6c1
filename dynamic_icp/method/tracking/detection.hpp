// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/tracking/cluster_velocity.hpp"
#include "dynamic_icp/method/tracking/ground.hpp"
#include "dynamic_icp/method/tracking/ground_heights.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/range_image.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"
#include "dynamic_icp/method/tracking/traffic_prior.hpp"

namespace dynamic_icp::tracking {

/// What one scan shows of one object, in world axes.
struct Detection {
  std::vector<Eigen::Vector3d> points;      ///< m, where each was measured
  std::vector<Eigen::Vector3d> directions;  ///< lines of sight, unit
  std::vector<double> radial;               ///< m/s, radial velocities over ground
  std::vector<double> times;                ///< s after the stamp of the scan
  std::vector<Eigen::Vector3d> levers;      ///< m: of a rig from `sensor` to the one that measured the point; or empty
  double mean_time_s = 0.0;
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();                  ///< where the sensor was at the mean time
  Eigen::Isometry3d T_sensor_world = Eigen::Isometry3d::Identity();  ///< at the mean time
  Ground ground;                                                     ///< below it, world
  std::optional<ClusterVelocity> motion;                             ///< by fit_motion; none: to be fitted
  const RangeImage* view = nullptr;                                  ///< of the whole scan; none: nothing is hidden
  const TrafficPrior* traffic = nullptr;                             ///< around it; none: nothing is known of it
};

/// The mean of some points, at least one.
Eigen::Vector3d mean_of(std::span<const Eigen::Vector3d> points);

/// Detections need so many points: a velocity has three unknowns.
inline constexpr std::size_t kMinDetectionPoints = 3;

/// Detections have no more points: they would not make them better.
inline constexpr std::size_t kMaxDetectionPoints = 500;

/// The rows of the scan (at least one) as a detection, in the memory of another one; of many an evenly spread part.
void make_detection(const Scan& scan, std::span<const double> radial, std::span<const std::uint32_t> rows,
                    const SensorMotion& sensor, const GroundHeights& heights, const RangeImage* view,
                    Detection& detection);

/// Memory on the stack for the points of a detection.
using DetectionMemory = StackMemory<kMaxDetectionPoints * sizeof(Eigen::Vector3d)>;

/// The radial velocities (m/s) as one sensor at `sensor` would measure them along the same lines of sight, if the body
/// turns with `yaw_rate_rps` about the upward axis: without Omega z x l of the lever arms.
std::pmr::vector<double> radial_at_sensor(const Detection& detection, double yaw_rate_rps, DetectionMemory& memory);

/// Fits the motion of the body once for all who will ask, unless it is seen by a rig: then it depends on its turning.
void fit_motion(double sigma_mps, Detection& detection);

/// What the Doppler says of a body that turns with `yaw_rate_rps` about the upward axis, as one sensor at `sensor`
/// would measure it; `sigma_mps` as in fit_cluster_velocity.
ClusterVelocity motion_of(const Detection& detection, double yaw_rate_rps, double sigma_mps);

/// The points where they would be seen at the mean time if all moved with `velocity` (m/s, world).
std::pmr::vector<Eigen::Vector3d> points_at_mean_time(const Detection& detection, const Eigen::Vector3d& velocity,
                                                      DetectionMemory& memory);

}  // namespace dynamic_icp::tracking
