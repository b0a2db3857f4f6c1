// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "dynamic_icp/method/odometry/odometry.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/synthetic_street.hpp"

// Drives through synthetic scenes, and how far it is from their equations.
namespace dynamic_icp::odometry::synthetic {

constexpr double kPeriod_s = 0.1;

/// Preset `default` without one of its parts.
inline WindowOdometryConfig with_ablation(std::string_view name) {
  WindowOdometryConfig config;
  apply_ablation(config, name);
  return config;
}

inline Sensor sweeping() {
  Sensor sensor;
  sensor.sweep_s = 0.1;
  return sensor;
}

/// A drive and what the odometry says of it.
struct Drive {
  World world = street();
  Path path = circle(10.0, 0.0);
  Sensor sensor;
  double period_s = kPeriod_s;
  std::uint64_t seed = 0;

  [[nodiscard]] RawScan scan(int k) const { return scan_at(world, path, sensor, k * period_s, seed).raw; }

  [[nodiscard]] std::vector<Frame> run(const Config& config, int scans, int threads = 1) const {
    const auto odometry = make_odometry(config, {}, threads);
    std::vector<Frame> frames;
    for (int k = 0; k < scans; ++k) {
      frames.push_back(odometry->process(scan(k)));
    }
    return frames;
  }
};

/// The error of the motion of a frame, from scan `from` to scan `to`.
struct MotionError {
  Vector6d left = Vector6d::Zero();  ///< left perturbation in the axes of scan `to`, as the covariance has it
  double move_m = 0.0;               ///< of the way, in the axes of scan `from`
  double turn_deg = 0.0;
};

inline MotionError error_of(const Drive& drive, const Frame& frame, int from, int to) {
  const Eigen::Isometry3d T_source_target =
      drive.path(from * drive.period_s).inverse() * drive.path(to * drive.period_s);
  const Eigen::Isometry3d E = frame.T_target_source * T_source_target;
  MotionError error;
  error.left = log_se3(E);
  error.move_m = (frame.T_target_source.inverse().translation() - T_source_target.translation()).norm();
  error.turn_deg = rotation_angle(E.linear()) * 180.0 / std::numbers::pi;
  return error;
}

/// Root mean square over the frames from `first` on.
inline MotionError rms_error(const Drive& drive, const std::vector<Frame>& frames, int first = 1) {
  MotionError sum;
  for (int k = first; k < static_cast<int>(frames.size()); ++k) {
    const MotionError error = error_of(drive, frames[static_cast<std::size_t>(k)], k - 1, k);
    sum.move_m += error.move_m * error.move_m;
    sum.turn_deg += error.turn_deg * error.turn_deg;
  }
  const auto count = static_cast<double>(static_cast<int>(frames.size()) - first);
  return {Vector6d::Zero(), std::sqrt(sum.move_m / count), std::sqrt(sum.turn_deg / count)};
}

inline Vector6d twist_error(const Drive& drive, const Frame& frame, int k) {
  Vector6d error;
  error << frame.twist->angular - turn_sensor(drive.path, k * drive.period_s),
      frame.twist->linear - velocity_sensor(drive.path, k * drive.period_s);
  return error;
}

/// Squared error over its stated variance: about the number of unknowns where the covariance is right.
inline double nis(const Vector6d& error, const Matrix6d& covariance) {
  return dense::normalised_squared(error, covariance);
}

inline bool same_bits(const Frame& a, const Frame& b) {
  bool same = a.status == b.status && a.T_world_sensor.matrix() == b.T_world_sensor.matrix() && a.labels == b.labels &&
              a.tracked.size() == b.tracked.size() && a.ego.joint_covariance == b.ego.joint_covariance;
  for (std::size_t k = 0; same && k < a.tracked.size(); ++k) {
    same = a.tracked[k].id == b.tracked[k].id && a.tracked[k].velocity_sensor == b.tracked[k].velocity_sensor &&
           a.tracked[k].covariance == b.tracked[k].covariance && a.tracked[k].members == b.tracked[k].members;
  }
  return same;
}

}  // namespace dynamic_icp::odometry::synthetic
