// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/ego_motion/support_plane.hpp"
#include "dynamic_icp/method/tracking/object_tracker.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"

namespace dynamic_icp::tracking {

inline constexpr double kScanPeriod_s = 0.1;
inline constexpr double kSensorHeight_m = 1.5;  ///< of the origin above the ground

// A world for tests: boxes that move on level ground, 1.5 m below the origin, before a distant wall, and a sensor that
// may move, turn, be tilted and sweep. Every point is where a ray meets a surface; every Doppler is that of the
// material point over ground.

/// A box and its motion at one time.
struct MovingBox {
  OrientedBox box;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of its centre
  double yaw_rate = 0.0;                               ///< rad/s
};

/// A car whose centre is at (x, y), driving with `speed` in the direction of `yaw`.
inline MovingBox car(double x, double y, double yaw, double speed, double yaw_rate = 0.0) {
  const Eigen::Matrix3d axes = upright_axes(yaw);
  return {{{x, y, -0.75}, axes, {4.4, 1.8, 1.5}}, speed * axes.col(0), yaw_rate};
}

/// What is there at a time.
using Traffic = std::function<std::vector<MovingBox>(double time_s)>;

/// How one looks at it.
struct Viewing {
  /// T_world_sensor at a time.
  std::function<Eigen::Isometry3d(double time_s)> pose = [](double) { return Eigen::Isometry3d::Identity(); };
  double sweep_s = 0.0;  ///< from the first ray to the last, from right to left; 0: all at once
  double outliers = 0.005;

  /// The sensor at a time, by differences of its poses.
  [[nodiscard]] SensorMotion motion(double time_s) const {
    constexpr double kStep_s = 1e-4;
    const Eigen::Isometry3d T_world_sensor = pose(time_s);
    const Eigen::Isometry3d later = pose(time_s + kStep_s);
    return {T_world_sensor, (later.translation() - T_world_sensor.translation()) / kStep_s,
            log_so3(T_world_sensor.linear().transpose() * later.linear()) / kStep_s};
  }
};

/// One scan, deskewed with the true motion of the sensor.
struct View {
  Scan scan;
  std::vector<double> radial;
  std::vector<std::uint8_t> is_moving;
  std::vector<std::int32_t> body;  ///< index of the box, -1 for ground and wall
};

/// Distance along the ray to the box, infinite when it misses.
inline double hit(const OrientedBox& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& u) {
  const Eigen::Array3d from = box.axes.transpose() * (origin - box.centre);
  const Eigen::Array3d slope = (box.axes.transpose() * u).array();
  const Eigen::Array3d a = (-0.5 * box.size.array() - from) / slope;
  const Eigen::Array3d b = (0.5 * box.size.array() - from) / slope;
  const double enter = a.min(b).maxCoeff();
  const double leave = a.max(b).minCoeff();
  return enter > 0.0 && enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

/// Where a ray ends.
struct Hit {
  double range = 100.0;  ///< m; of the wall
  std::int32_t body = -1;
  double radial = 0.0;  ///< m/s, of the material point along the ray
};

inline Hit first_hit(const std::vector<MovingBox>& boxes, const Eigen::Vector3d& origin, const Eigen::Vector3d& u) {
  Hit first;
  if (u.z() < 0.0) {
    first.range = std::min(first.range, -(origin.z() + kSensorHeight_m) / u.z());
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double distance = hit(boxes[i].box, origin, u);
    if (distance < first.range) {
      const Eigen::Vector3d arm = origin + distance * u - boxes[i].box.centre;
      const Eigen::Vector3d velocity = boxes[i].velocity + boxes[i].yaw_rate * Eigen::Vector3d::UnitZ().cross(arm);
      first = {distance, static_cast<std::int32_t>(i), u.dot(velocity)};
    }
  }
  return first;
}

/// What is seen from `time_s` on: rays 0.25 degrees apart sideways and 0.5 up and down, 2 cm and 5 cm/s of noise, and a
/// share of gross Doppler errors.
inline View view_of(const Traffic& traffic, double time_s, const Viewing& viewing) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  View view;
  RawScan raw;
  raw.stamp = {static_cast<std::int64_t>(std::llround(1e9 * time_s))};
  const RandomSource random = RandomSource(31).fork(static_cast<std::uint64_t>(raw.stamp.ns));
  const Eigen::Isometry3d T_stamp_world = viewing.pose(time_s).inverse();
  std::uint64_t ray = 0;
  for (double azimuth = -60.0; azimuth <= 60.0; azimuth += 0.25) {
    const double after = viewing.sweep_s * (azimuth + 60.0) / 120.0;
    const std::vector<MovingBox> boxes = traffic(time_s + after);
    const Eigen::Isometry3d T_world_sensor = viewing.pose(time_s + after);
    for (double elevation = -12.0; elevation <= 4.0; elevation += 0.5) {
      const RandomSource one = random.fork(++ray);
      const double c = std::cos(elevation * kDegree);
      const Eigen::Vector3d u(c * std::cos(azimuth * kDegree), c * std::sin(azimuth * kDegree),
                              std::sin(elevation * kDegree));
      const Eigen::Vector3d u_world = T_world_sensor.linear() * u;
      const Hit first = first_hit(boxes, T_world_sensor.translation(), u_world);
      const bool gross = one.uniform(0) < viewing.outliers;
      const double range = first.range + 0.02 * one.normal(1);
      raw.points.emplace_back(T_stamp_world * (T_world_sensor.translation() + range * u_world));
      raw.directions.push_back(u);
      raw.doppler.push_back(gross ? one.uniform(2, -30.0, 30.0) : first.radial + 0.05 * one.normal(3));
      if (viewing.sweep_s > 0.0) {
        raw.times.push_back(after);
      }
      view.body.push_back(first.body);
    }
  }
  view.scan = Scan::from_raw(raw);
  view.radial = view.scan.doppler();
  for (const double radial : view.radial) {
    view.is_moving.push_back(std::abs(radial) > 0.3 ? 1 : 0);
  }
  return view;
}

/// What a sensor at rest in the origin sees at once.
inline View view_of(const std::vector<MovingBox>& boxes, double time_s, double outliers = 0.005) {
  Viewing viewing;
  viewing.outliers = outliers;
  return view_of([&](double) { return boxes; }, time_s, viewing);
}

/// Rows of the scan on a body, ascending.
inline std::vector<std::uint32_t> rows_on(const View& view, std::int32_t body) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < view.body.size(); ++row) {
    if (view.body[row] == body) {
      rows.push_back(row);
    }
  }
  return rows;
}

/// The ground in the frame of a sensor.
inline ego_motion::SupportPlane ground_from(const Eigen::Isometry3d& T_world_sensor) {
  return {T_world_sensor.linear().transpose() * Eigen::Vector3d::UnitZ(),
          -kSensorHeight_m - T_world_sensor.translation().z()};
}

inline std::vector<TrackedObject> step(ObjectTracker& tracker, const View& view, const SensorMotion& sensor = {},
                                       int threads = 1) {
  const auto objects = tracker.update(view.scan, view.radial, view.is_moving, sensor,
                                      ground_from(sensor.T_world_sensor), Workers(threads));
  return {objects.begin(), objects.end()};
}

inline std::vector<TrackedObject> confirmed(const std::vector<TrackedObject>& all) {
  std::vector<TrackedObject> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [](const TrackedObject& object) { return object.status == TrackStatus::kConfirmed; });
  return result;
}

/// The object nearest to a place.
inline const TrackedObject& nearest(const std::vector<TrackedObject>& objects, const Eigen::Vector3d& place) {
  return *std::min_element(objects.begin(), objects.end(), [&](const TrackedObject& a, const TrackedObject& b) {
    return (a.centroid - place).norm() < (b.centroid - place).norm();
  });
}

}  // namespace dynamic_icp::tracking
