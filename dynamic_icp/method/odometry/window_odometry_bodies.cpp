// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/window_odometry.hpp"

// Preset `default`: moving objects as the estimator asks for them.
#include <algorithm>
#include <utility>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::odometry {
namespace {

// Of an object, evenly over its rows: more tell hardly more.
constexpr std::size_t kMaxBodyPoints = 800;
constexpr std::size_t kMaxBodyDoppler = 24;

std::size_t step_for(std::size_t size, std::size_t most) { return std::max<std::size_t>(1, size / most); }

}  // namespace

/// Of the scan at hand, deskewed by the motion of the sensor: points of an object are moved to their mean time by its
/// own.
std::vector<window::SeenBody> WindowOdometry::measured_bodies(std::span<const tracking::TrackedObject> objects,
                                                              const motion::SweepMotion& sweep,
                                                              const Eigen::Isometry3d& T_world_sensor) const {
  std::vector<window::SeenBody> bodies;
  if (!estimator_.asks_bodies()) {
    return bodies;
  }
  const Scan& whole = memory_.whole;
  const Eigen::Matrix3d R_world_sensor = T_world_sensor.linear();
  const auto time_of = [&](std::uint32_t row) { return whole.has_times() ? whole.times()[row] : 0.0; };
  for (const tracking::TrackedObject& object : objects) {
    const std::vector<std::uint32_t>& rows = object.members;
    if (rows.empty()) {
      continue;
    }
    double mean_s = 0.0;
    for (const std::uint32_t row : rows) {
      mean_s += time_of(row) / static_cast<double>(rows.size());
    }
    window::SeenBody body;
    body.id = object.id;
    body.time_s = estimator_.stamp_s() + mean_s;
    body.velocity = R_world_sensor * object.velocity_sensor;
    body.omega = R_world_sensor * (object.yaw_rate_rps * object.box.axes.col(2));
    body.centre = T_world_sensor * object.box.centre + mean_s * body.velocity;
    const auto place = [&](std::uint32_t row) -> Eigen::Vector3d {
      return T_world_sensor * whole.points()[row] - (time_of(row) - mean_s) * body.velocity;
    };
    for (std::size_t k = 0; k < rows.size(); k += step_for(rows.size(), kMaxBodyPoints)) {
      body.points.push_back(place(rows[k]));
    }
    for (std::size_t k = 0; k < rows.size(); k += step_for(rows.size(), kMaxBodyDoppler)) {
      const std::uint32_t row = rows[k];
      window::BodyDoppler one;
      one.u = R_world_sensor * exp_so3(time_of(row) * sweep.omega) * whole.directions()[row];
      one.lever = place(row) - body.centre;
      one.columns = estimator_.columns_of(whole, row);
      one.s = memory_.measured[row] - memory_.predicted[row];
      body.doppler.push_back(one);
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace dynamic_icp::odometry
