// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kSteepest_rad = 0.35;  // against the last ground
constexpr std::size_t kMemory = 9;      // scans
constexpr double kFewGround = 0.25;     // at least this share of them shows the ground ...
constexpr double kSameHeight_m = 0.3;   // ... whose height changes by no more meanwhile

}  // namespace

const Ground& GroundFilter::update(const Eigen::Vector3d& normal, double offset_m,
                                   const Eigen::Vector3d& sensor_world) {
  if (normal.dot(ground_.up()) < std::cos(kSteepest_rad)) {
    return ground_;
  }
  const Plane plane{normal, normal.dot(sensor_world) - offset_m};
  if (last_.size() < kMemory) {
    last_.push_back(plane);
  } else {
    last_[next_] = plane;
    next_ = (next_ + 1) % kMemory;
  }
  // What bounds a scene besides the ground passes below the ground near the carrier, so it is farther from the sensor.
  std::array<double, kMemory> values;
  std::transform(last_.begin(), last_.end(), values.begin(), [](const Plane& one) { return one.height_m; });
  const double highest_m = quantile_among(std::span(values).first(last_.size()), kFewGround) + kSameHeight_m;
  const auto median_of = [&](const auto& part) {
    std::size_t count = 0;
    for (const Plane& one : last_) {
      if (one.height_m <= highest_m) {
        values[count++] = part(one);
      }
    }
    return quantile_among(std::span(values).first(count), 0.5);
  };
  Eigen::Vector3d up;
  for (int axis = 0; axis < 3; ++axis) {
    up[axis] = median_of([&](const Plane& one) { return one.normal[axis]; });
  }
  up.normalize();
  // The shortest turn from the last normal to this one: headings in the ground stay what they are.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(ground_.up(), up);
  ground_.level = turn.toRotationMatrix() * ground_.level;
  ground_.offset_m = up.dot(sensor_world) - median_of([](const Plane& one) { return one.height_m; });
  return ground_;
}

void GroundFilter::state(StateArchive& archive) {
  archive.each(last_, [&](Plane& plane) { archive(plane.normal, plane.height_m); });
  archive(next_, ground_.level, ground_.offset_m);
  archive.require(last_.size() <= kMemory && next_ < kMemory, "the memory of the ground");
}

}  // namespace dynamic_icp::tracking
