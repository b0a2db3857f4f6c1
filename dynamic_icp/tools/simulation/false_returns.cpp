// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/false_returns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamic_icp/tools/simulation/random_streams.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr double kSprayLength = 8.0;  // m
constexpr double kSprayHeight = 1.5;  // m
constexpr double kSprayDecay = 5.0;   // m
constexpr double kSprayShare = 0.6;   // of the body's velocity
constexpr double kSpraySpeed = 5.0;   // m/s: slower wheels throw up nothing

/// A return of something small that is there and moves on its own.
Return free_return(ReturnKind kind, double range, double doppler) {
  Return result;
  result.kind = kind;
  result.body = kNoBody;
  result.echo = {range, 0.0, 1.0};
  result.true_range = range;
  result.true_doppler = doppler;
  result.doppler = doppler;
  return result;
}

/// The part of a half line within a box; empty where begin > end.
struct Stretch {
  double begin = 0.0;
  double end = 0.0;
};

Stretch stretch_in(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Stretch stretch{0.0, std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    const double to_min = (box.min()[axis] - origin[axis]) / direction[axis];
    const double to_max = (box.max()[axis] - origin[axis]) / direction[axis];
    stretch.begin = std::max(stretch.begin, std::min(to_min, to_max));
    stretch.end = std::min(stretch.end, std::max(to_min, to_max));
  }
  return stretch;
}

Eigen::AlignedBox3d cloud_behind(const Eigen::AlignedBox3d& body) {
  Eigen::AlignedBox3d cloud = body;
  cloud.max().x() = body.min().x();
  cloud.min().x() = body.min().x() - kSprayLength;
  cloud.max().z() = body.min().z() + kSprayHeight;
  return cloud;
}

}  // namespace

Return rain_drop(const Moment& moment, const Eigen::Vector3d& direction_sensor, double range,
                 const RandomSource& random) {
  const Eigen::Vector3d velocity_world(random.normal(kRainVelocity), random.normal(kRainVelocity + 1),
                                       -6.0 + random.normal(kRainVelocity + 2));
  return free_return(ReturnKind::kRain, range,
                     range_rate(moment.sensor.T_world_body.linear() * direction_sensor, velocity_world, moment.sensor));
}

std::optional<Return> spray_drop(const Moment& moment, const world::World& world,
                                 const Eigen::Vector3d& direction_sensor, double free_range_m, double rate,
                                 const RandomSource& random) {
  if (!(random.uniform(kSpray) < rate)) {
    return std::nullopt;
  }
  const Eigen::Vector3d origin = moment.sensor.T_world_body.translation();
  const Eigen::Vector3d along = moment.sensor.T_world_body.linear() * direction_sensor;
  for (std::size_t i = 0; i < moment.bodies.size(); ++i) {
    const world::MotionState& body = moment.bodies[i].motion;
    if (body.velocity_world.norm() < kSpraySpeed) {
      continue;
    }
    const Eigen::Isometry3d T_body_world = body.T_world_body.inverse();
    const Eigen::Vector3d origin_body = T_body_world * origin;
    const Eigen::Vector3d along_body = T_body_world.linear() * along;
    const Eigen::AlignedBox3d cloud = cloud_behind(world.shapes[world.bodies[i].shape].box);
    const Stretch within = stretch_in(cloud, origin_body, along_body);
    const double range = within.begin + random.uniform(kSprayRange) * (within.end - within.begin);
    if (within.begin >= within.end || range >= free_range_m) {
      continue;
    }
    const double behind_m = cloud.max().x() - (origin_body + range * along_body).x();
    const Eigen::Vector3d drift(random.normal(kSprayVelocity), random.normal(kSprayVelocity + 1),
                                random.normal(kSprayVelocity + 2));
    const Eigen::Vector3d velocity_world =
        kSprayShare * std::exp(-behind_m / kSprayDecay) * body.velocity_world + 0.5 * drift;
    return free_return(ReturnKind::kSpray, range, range_rate(along, velocity_world, moment.sensor));
  }
  return std::nullopt;
}

Return window_return(const RandomSource& random) {
  return free_return(ReturnKind::kWindow, random.uniform(kWindowRange, 0.1, 0.5), 0.0);
}

Return ghost(const Moment& moment, const MirrorImage& image) {
  // The image of the point that is seen moves as it does, mirrored, and with twice the mirror's own motion.
  const Eigen::Vector3d& n = image.mirror_normal;
  const Eigen::Vector3d velocity_image =
      image.seen_velocity - 2.0 * n * n.dot(image.seen_velocity - image.mirror_velocity);
  const double range = image.mirror_range_m + image.seen.range_m;
  Return result =
      free_return(ReturnKind::kGhost, range, range_rate(image.direction_world, velocity_image, moment.sensor));
  result.echo = image.seen;
  result.echo.range_m = range;
  return result;
}

}  // namespace dynamic_icp::simulation
