// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

// Trajectories for the tests of this room. A scan is 0.1 s after the one before it.
namespace dynamic_icp::evaluation {

constexpr std::int64_t kFrameNs = 100'000'000;

inline Eigen::Isometry3d random_motion(std::mt19937& random, double angle_rad, double distance_m) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vector6d xi;
  for (double& x : xi) {
    x = uniform(random);
  }
  xi.head<3>() *= angle_rad;
  xi.tail<3>() *= distance_m;
  return exp_se3(xi);
}

/// Poses of a drive: about 2 m forward a scan, turning at random.
inline formats::Trajectory random_drive(std::mt19937& random, std::size_t count) {
  formats::Trajectory trajectory;
  Eigen::Isometry3d T = random_motion(random, 3.0, 50.0);
  for (std::size_t k = 0; k < count; ++k) {
    trajectory.push_back({{static_cast<std::int64_t>(k) * kFrameNs}, T});
    T = T * Eigen::Translation3d(2.0, 0.0, 0.0) * random_motion(random, 0.05, 0.3);
  }
  return trajectory;
}

/// The same poses with every motion disturbed: what an odometry makes of a drive.
inline formats::Trajectory disturbed(std::mt19937& random, const formats::Trajectory& truth, double angle_rad,
                                     double distance_m) {
  formats::Trajectory estimate = {truth.front()};
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Eigen::Isometry3d motion = truth[k - 1].T_world_sensor.inverse() * truth[k].T_world_sensor;
    estimate.push_back(
        {truth[k].stamp, estimate[k - 1].T_world_sensor * motion * random_motion(random, angle_rad, distance_m)});
  }
  return estimate;
}

/// One pose a scan without rotation, at the given x.
inline formats::Trajectory along_x(const std::vector<double>& xs) {
  formats::Trajectory trajectory;
  for (std::size_t k = 0; k < xs.size(); ++k) {
    trajectory.push_back({{static_cast<std::int64_t>(k) * kFrameNs}, Eigen::Isometry3d::Identity()});
    trajectory.back().T_world_sensor.translation().x() = xs[k];
  }
  return trajectory;
}

/// Every pose moved by T_new_world from the left.
inline formats::Trajectory moved(formats::Trajectory trajectory, const Eigen::Isometry3d& T_new_world) {
  for (formats::StampedPose& pose : trajectory) {
    pose.T_world_sensor = T_new_world * pose.T_world_sensor;
  }
  return trajectory;
}

/// Every position multiplied; orientations as they are.
inline formats::Trajectory scaled(formats::Trajectory trajectory, double factor) {
  for (formats::StampedPose& pose : trajectory) {
    pose.T_world_sensor.translation() *= factor;
  }
  return trajectory;
}

}  // namespace dynamic_icp::evaluation
