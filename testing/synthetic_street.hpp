// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"

// Scenes made of boxes and planes, a sensor that moves through them on a path given by equations, and its rays: scans
// whose true motion, velocity and objects are known exactly.
namespace dynamic_icp::odometry::synthetic {

using Eigen::Vector3d;

/// An upright block, standing or moving.
struct Box {
  Vector3d low = Vector3d::Zero();  ///< m, at time 0
  Vector3d high = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();  ///< m/s
};

struct World {
  bool has_ground = true;          ///< at z = 0
  double tube_half_width_m = 0.0;  ///< walls along x at y = +- this, and a ceiling; 0: open
  double tube_height_m = 5.0;
  std::vector<Box> boxes;
  std::vector<Box> cars;
};

/// Where a ray ends.
struct Hit {
  double range_m = std::numeric_limits<double>::infinity();
  int car = -1;  ///< or -1 for what stands
};

/// Distance along a ray to where it enters a box, infinite when it misses.
inline double range_to_box(const Vector3d& origin, const Vector3d& direction, const Vector3d& low,
                           const Vector3d& high) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double one = (low[axis] - origin[axis]) / direction[axis];
    const double other = (high[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter > 0.0 && enter < leave ? enter : std::numeric_limits<double>::infinity();
}

inline Hit cast(const World& world, const Vector3d& origin, const Vector3d& direction, double time_s) {
  Hit hit;
  const auto meet_plane = [&](int axis, double at) {
    const double range = (at - origin[axis]) / direction[axis];
    hit.range_m = range > 0.0 ? std::min(hit.range_m, range) : hit.range_m;
  };
  if (world.has_ground) {
    meet_plane(2, 0.0);
  }
  if (world.tube_half_width_m > 0.0) {
    meet_plane(1, world.tube_half_width_m);
    meet_plane(1, -world.tube_half_width_m);
    meet_plane(2, world.tube_height_m);
  }
  for (const Box& box : world.boxes) {
    hit.range_m = std::min(hit.range_m, range_to_box(origin, direction, box.low, box.high));
  }
  for (std::size_t k = 0; k < world.cars.size(); ++k) {
    const Box& car = world.cars[k];
    const Vector3d moved = time_s * car.velocity;
    const double range = range_to_box(origin, direction, car.low + moved, car.high + moved);
    if (range < hit.range_m) {
      hit = {range, static_cast<int>(k)};
    }
  }
  return hit;
}

/// House fronts 9 m left and right of the x axis, set back by 1.5 m every 8 m, of different heights; lamp posts.
inline World street() {
  World world;
  for (int k = -2; k < 30; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const double x = 8.0 * k + (side > 0.0 ? 3.0 : 0.0);
      const double height = 5.0 + 2.0 * ((k + 2) % 3);
      const auto block = [&](double from, double to, double near_m, double far_m) {
        const double y = side * near_m;
        const double other = side * far_m;
        world.boxes.push_back({{x + from, std::min(y, other), 0.0}, {x + to, std::max(y, other), height}});
      };
      block(0.0, 5.0, 9.0, 14.0);
      block(5.0, 8.0, 10.5, 14.0);
      if (k % 2 == 0) {
        block(2.0, 2.3, 7.0, 7.3);
      }
    }
  }
  return world;
}

/// One drives ahead, one comes towards the sensor.
inline World street_with_cars() {
  World world = street();
  world.cars = {{{16.0, -2.9, 0.1}, {20.3, -1.1, 1.6}, {12.0, 0.0, 0.0}},
                {{45.0, 2.0, 0.1}, {49.5, 3.8, 1.5}, {-9.0, 0.0, 0.0}}};
  return world;
}

inline World tunnel() {
  World world;
  world.tube_half_width_m = 4.5;
  return world;
}

inline World plain() { return {}; }

/// A path: the pose of the sensor at any time.
using Path = std::function<Eigen::Isometry3d(double time_s)>;

constexpr double kHeight_m = 1.8;

/// Even speed, even turn to the left. A sensor that looks along the path.
inline Path circle(double speed_mps, double turn_radps) {
  return [=](double t) {
    const double angle = turn_radps * t;
    const double chord = std::abs(angle) > 1e-9 ? std::sin(0.5 * angle) / (0.5 * angle) : 1.0;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = exp_so3(angle * Vector3d::UnitZ());
    T.translation() = exp_so3(0.5 * angle * Vector3d::UnitZ()) * Vector3d(speed_mps * t * chord, 0.0, 0.0);
    T.translation().z() = kHeight_m;
    return T;
  };
}

/// A vehicle that changes its speed (by 20 % and 2 m/s^2 or so) and its direction (0.25 rad/s), rolls, pitches and
/// heaves; the sensor sits ahead of and beside the point that follows the path, tilted by some degrees.
inline Path agile(double speed_mps) {
  return [=](double t) {
    constexpr double kBend = 0.9;  // rad/s
    const double x = speed_mps * (t + 0.2 * std::sin(t));
    const double y = 2.0 * (1.0 - std::cos(kBend * t));
    const double yaw = std::atan2(2.0 * kBend * std::sin(kBend * t), speed_mps * (1.0 + 0.2 * std::cos(t)));
    Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
    T_world_body.translation() = Vector3d(x, y, 0.02 * std::sin(6.0 * t));
    T_world_body.linear() = exp_so3(yaw * Vector3d::UnitZ()) * exp_so3(0.006 * std::sin(5.0 * t) * Vector3d::UnitY()) *
                            exp_so3(0.008 * std::sin(4.0 * t + 1.0) * Vector3d::UnitX());
    Eigen::Isometry3d T_body_sensor = Eigen::Isometry3d::Identity();
    T_body_sensor.translation() = Vector3d(1.2, 0.4, kHeight_m);
    T_body_sensor.linear() = exp_so3(Vector3d(0.02, 0.03, -0.03));
    return Eigen::Isometry3d(T_world_body * T_body_sensor);
  };
}

/// m/s, in the axes of the sensor at that time: central differences, exact to 1e-8.
inline Vector3d velocity_sensor(const Path& path, double t) {
  constexpr double kStep = 1e-4;
  return path(t).linear().transpose() * (path(t + kStep).translation() - path(t - kStep).translation()) / (2.0 * kStep);
}

/// rad/s, in the axes of the sensor at that time.
inline Vector3d turn_sensor(const Path& path, double t) {
  constexpr double kStep = 1e-4;
  return log_so3(path(t - kStep).linear().transpose() * path(t + kStep).linear()) / (2.0 * kStep);
}

/// 120 x 20 degrees, columns from right to left.
struct Sensor {
  int columns = 240;
  int rows = 32;
  double sweep_s = 0.0;  ///< 0: all points at once
  bool gives_times = true;
  double range_noise_m = 0.02;
  double doppler_noise_mps = 0.05;
  double outliers = 0.005;  ///< share of points with a Doppler from -30 to 30 m/s
  double bias_mps = 0.0;
  double reach_m = 120.0;
  double width_rad = 120.0 / 180.0 * std::numbers::pi;
};

/// A scan and which car each of its points is on, -1 for none.
struct TrueScan {
  RawScan raw;
  std::vector<int> car;
};

inline Stamp stamp_at(double time_s) { return {std::llround(1e9 * time_s)}; }

/// The scan that begins at `time_s`. Each scan looks at other points, with other noise.
inline TrueScan scan_at(const World& world, const Path& path, const Sensor& sensor, double time_s,
                        std::uint64_t seed = 0) {
  const RandomSource random = RandomSource(seed).fork(static_cast<std::uint64_t>(stamp_at(time_s).ns));
  TrueScan scan;
  scan.raw.stamp = stamp_at(time_s);
  for (int column = 0; column < sensor.columns; ++column) {
    const RandomSource of_column = random.fork(static_cast<std::uint64_t>(column));
    const double tau = sensor.sweep_s * (column + 0.5) / sensor.columns;
    const Eigen::Isometry3d T_world_sensor = path(time_s + tau);
    const Vector3d velocity_world = T_world_sensor.linear() * velocity_sensor(path, time_s + tau);
    for (int row = 0; row < sensor.rows; ++row) {
      const RandomSource of_ray = of_column.fork(static_cast<std::uint64_t>(row));
      const double azimuth = sensor.width_rad * ((column + of_ray.uniform(0)) / sensor.columns - 0.5);
      const double elevation = 0.34 * ((row + of_ray.uniform(1)) / sensor.rows - 0.5);
      const Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                               std::sin(elevation));
      const Vector3d direction_world = T_world_sensor.linear() * direction;
      const Hit hit = cast(world, T_world_sensor.translation(), direction_world, time_s + tau);
      if (hit.range_m > sensor.reach_m) {
        continue;
      }
      const Vector3d target_velocity =
          hit.car >= 0 ? world.cars[static_cast<std::size_t>(hit.car)].velocity : Vector3d(Vector3d::Zero());
      const double doppler = direction_world.dot(target_velocity - velocity_world) + sensor.bias_mps;
      const bool is_wild = of_ray.uniform(2) < sensor.outliers;
      scan.raw.points.push_back((hit.range_m + sensor.range_noise_m * of_ray.normal(3)) * direction);
      scan.raw.doppler.push_back(is_wild ? of_ray.uniform(4, -30.0, 30.0)
                                         : doppler + sensor.doppler_noise_mps * of_ray.normal(5));
      scan.car.push_back(hit.car);
      if (sensor.sweep_s > 0.0 && sensor.gives_times) {
        scan.raw.times.push_back(tau);
      }
    }
  }
  return scan;
}

}  // namespace dynamic_icp::odometry::synthetic
