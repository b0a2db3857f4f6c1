// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace dynamic_icp::tracking {
namespace {

constexpr double kSteepest_rad = 0.35;  // against the last ground
constexpr double kGain = 0.2;           // of a new normal

}  // namespace

Ground updated_ground(const Ground& last, const Eigen::Vector3d& normal, double offset_m,
                      const Eigen::Vector3d& sensor_world) {
  if (normal.dot(last.up()) < std::cos(kSteepest_rad)) {
    return last;
  }
  const Eigen::Vector3d up =
      last.offset_m ? Eigen::Vector3d((1.0 - kGain) * last.up() + kGain * normal).normalized() : normal;
  // The shortest turn from the last normal to this one: headings in the ground stay what they are.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(last.up(), up);
  const Eigen::Vector3d below_sensor = sensor_world - (normal.dot(sensor_world) - offset_m) * normal;
  return {turn.toRotationMatrix() * last.level, up.dot(below_sensor)};
}

}  // namespace dynamic_icp::tracking
