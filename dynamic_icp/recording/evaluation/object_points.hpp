// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

namespace dynamic_icp::evaluation {

/// The points of a scan and the bodies that they lie on.
struct PointsOnBodies {
  std::span<const Eigen::Vector3d> points;  ///< m, sensor frame at the time of each point
  std::span<const double> times;            ///< s after the stamp; empty: all at the stamp
  std::span<const std::int32_t> labels;     ///< id of the moving body in truth
};

/// T_stamp_time of the sensor, s after the stamp; nothing where its motion is not known.
using SensorMotion = std::function<std::optional<Eigen::Isometry3d>(double)>;

/// How far a point may lie from the box that holds it, m: ranges have noise, and bodies are round.
constexpr double kHeldWithin_m = 0.15;

/// Distance of a point to a box, m; 0 within it.
double distance_to(const Box& box, const Eigen::Vector3d& point);

/// The share, 0 to 1, of the points of the true body of a pair that lie in the reported box or at most kHeldWithin_m
/// from it. The sensor and the body move while a scan is taken: a point p measured at time t lies at
///
///   c + R_z(-yaw_rate t) (T_stamp_t p - v t - c)
///
/// at the stamp, with the true centre c, velocity v and yaw rate about the z axis of the true box. Points at times when
/// the motion of the sensor is not known are left out; empty where there are no others.
std::optional<double> held_share(const BodyPair& pair, const PointsOnBodies& scan, const SensorMotion& T_stamp_time);

/// The shares of all pairs in two numbers.
HeldPoints held_points(std::vector<double> shares);

/// Points that a run takes for static, and those of them that lie on moving bodies.
struct StaticPoints {
  std::size_t all = 0;
  std::size_t on_moving = 0;

  /// Adds those of a scan: labels of the same points by the run, 0 static, and in truth, > 0 the moving body.
  void add(std::span<const std::int32_t> reported, std::span<const std::int32_t> truth);
  /// Empty without points.
  [[nodiscard]] std::optional<double> share_on_moving() const;
};

}  // namespace dynamic_icp::evaluation
