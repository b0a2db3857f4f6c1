// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/ray_returns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "dynamic_icp/tools/simulation/false_returns.hpp"
#include "dynamic_icp/tools/simulation/random_streams.hpp"
#include "dynamic_icp/tools/simulation/scan_pattern.hpp"
#include "dynamic_icp/tools/world/foliage.hpp"

namespace dynamic_icp::simulation {
namespace {

// A second surface in the beam is one of its own when it is off the plane of the first by more than this.
constexpr double kEdgeStep = 0.02;  // m

constexpr double kGrain = 0.01;     // m: cells of a rough surface of one height
constexpr double kMinCosine = 0.1;  // cosine: rough surfaces met at a smaller one hide their own valleys

/// Embree must not see a pose that is not finite.
void check_pose(const world::MotionState& motion, const char* whose, double time_s) {
  if (!motion.T_world_body.matrix().allFinite()) {
    throw std::invalid_argument(std::string("the pose of ") + whose + " is not finite at " + std::to_string(time_s) +
                                " s");
  }
}

}  // namespace

double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const world::MotionState& sensor) {
  return direction_world.dot(velocity_point_world - sensor.velocity_world);
}

Moment moment_at(const Surroundings& surroundings, double time_s) {
  Moment moment{time_s, surroundings.sensor(time_s), world::bodies_at(surroundings.world, time_s)};
  check_pose(moment.sensor, "the sensor", time_s);
  for (const world::BodyAt& body : moment.bodies) {
    check_pose(body.motion, "a moving body", time_s);
  }
  return moment;
}

std::optional<Return> RayReturns::find(const Moment& moment, double azimuth, double elevation,
                                       const RandomSource& random) const {
  if (config_.window_rate > 0.0 && random.uniform(kWindow) < config_.window_rate) {
    return window_return(random);
  }
  const Eigen::Vector3d axis = direction(azimuth, elevation);
  std::optional<Hit> hit = cast(moment, axis);
  const double free_way = hit ? hit->result.true_range : config_.max_range_m;
  if (config_.rain_rate > 0.0 && random.uniform(kRain) < config_.rain_rate) {
    const double range = -config_.rain_range_m * std::log(1.0 - random.uniform(kRainRange));
    if (range >= config_.min_range_m && range < free_way) {
      return rain_drop(moment, axis, range, random);
    }
  }
  if (config_.spray_rate > 0.0) {
    const auto drop = spray_drop(moment, surroundings_.world, axis, free_way, config_.spray_rate, random);
    if (drop && drop->true_range >= config_.min_range_m) {
      return drop;
    }
  }
  std::optional<Return> found = hit ? std::optional(hit->result) : std::nullopt;
  if (config_.beam_divergence_mrad > 0.0) {
    found = over_the_beam(moment, hit, azimuth, elevation, random);
  }
  if (!found || found->true_range < config_.min_range_m) {
    return std::nullopt;
  }
  const bool is_mirror = hit && config_.multipath_rate > 0.0 && random.uniform(kMultipath) < config_.multipath_rate;
  return is_mirror ? mirrored(moment, *hit) : found;
}

/// The surface that a ray of the beam meets.
std::optional<RayReturns::Hit> RayReturns::cast(const Moment& moment, const Eigen::Vector3d& direction_sensor) const {
  const Eigen::Isometry3d& T_world_sensor = moment.sensor.T_world_body;
  return cast(moment, {T_world_sensor.translation(), T_world_sensor.linear() * direction_sensor, config_.max_range_m});
}

std::optional<RayReturns::Hit> RayReturns::cast(const Moment& moment, const world::Ray& ray) const {
  const std::optional<world::RayHit> surface = surroundings_.caster.cast(ray, moment.bodies);
  if (!surface) {
    return std::nullopt;
  }
  const Eigen::Vector3d point_world = ray.origin_world + surface->range_m * ray.direction_world;
  Return result;
  Eigen::Vector3d velocity_point = Eigen::Vector3d::Zero();
  if (surface->body) {
    velocity_point = world::point_velocity(moment.bodies[*surface->body].motion, point_world);
    result.body = surroundings_.world.bodies[*surface->body].id;
  }
  const double cosine = std::abs(surface->normal_world.dot(ray.direction_world));
  double range_m = surface->range_m;
  if (config_.roughness_m > 0.0) {
    range_m -= roughness(moment, *surface, point_world) / std::max(cosine, kMinCosine);
  }
  if (config_.foliage_sway_m > 0.0 && surface->foliage) {
    const world::LeafMotion leaf = world::leaf_motion(point_world, moment.time_s, config_.foliage_sway_m);
    range_m += ray.direction_world.dot(leaf.displacement);
    velocity_point += leaf.velocity;
  }
  result.echo = {range_m, surface->reflectivity, cosine};
  result.doppler = range_rate(ray.direction_world, velocity_point, moment.sensor);
  result.true_range = result.echo.range_m;
  result.true_doppler = result.doppler;
  return Hit{point_world, surface->normal_world, velocity_point, result};
}

/// Height (m) of a rough surface over the mesh at this point: a random number for each cell of 1 cm of the body.
double RayReturns::roughness(const Moment& moment, const world::RayHit& surface,
                             const Eigen::Vector3d& point_world) const {
  const Eigen::Vector3d point =
      surface.body ? Eigen::Vector3d(moment.bodies[*surface.body].motion.T_world_body.inverse() * point_world)
                   : point_world;
  RandomSource cell(surface.body ? *surface.body + 1 : 0);
  for (const double coordinate : point) {
    cell = cell.fork(static_cast<std::uint64_t>(std::llround(coordinate / kGrain)));
  }
  return config_.roughness_m * cell.normal(0);
}

/// What is seen in a surface as in a mirror.
std::optional<Return> RayReturns::mirrored(const Moment& moment, const Hit& mirror) const {
  const Eigen::Vector3d origin = moment.sensor.T_world_body.translation();
  const Eigen::Vector3d direction_world = (mirror.point_world - origin).normalized();
  const Eigen::Vector3d& n = mirror.normal_world;
  const Eigen::Vector3d onward = direction_world - 2.0 * n * n.dot(direction_world);
  constexpr double kOffTheMirror = 1e-4;  // m: or the ray meets the mirror again
  const double mirror_range_m = (mirror.point_world - origin).norm() + kOffTheMirror;
  const std::optional<Hit> seen =
      cast(moment, {mirror.point_world + kOffTheMirror * onward, onward, config_.max_range_m - mirror_range_m});
  if (!seen) {
    return std::nullopt;
  }
  return ghost(moment,
               {direction_world, n, mirror.velocity_world, mirror_range_m, seen->velocity_world, seen->result.echo});
}

/// A beam has a width: a second ray within it tells whether it falls on an edge. The part of the beam beside the edge
/// is lost or meets another surface. Returns of two surfaces that the sensor resolves compete, the stronger is
/// reported; others melt into one between them.
std::optional<Return> RayReturns::over_the_beam(const Moment& moment, const std::optional<Hit>& on_axis, double azimuth,
                                                double elevation, const RandomSource& random) const {
  const double radius = 0.5e-3 * config_.beam_divergence_mrad * std::sqrt(random.uniform(kBeamRadius));
  const double angle = 2.0 * std::numbers::pi * random.uniform(kBeamAngle);
  const std::optional<Hit> aside = cast(moment, direction(azimuth + radius * std::cos(angle) / std::cos(elevation),
                                                          elevation + radius * std::sin(angle)));
  const double share_aside = random.uniform(kBeamShare, 0.0, 0.5);
  if (!on_axis && !aside) {
    return std::nullopt;
  }
  if (!aside || !on_axis) {
    Return partial = on_axis ? on_axis->result : aside->result;
    partial.echo.beam_share = on_axis ? 1.0 - share_aside : share_aside;
    return partial;
  }
  return is_edge(*on_axis, *aside) ? at_edge(on_axis->result, aside->result, share_aside) : on_axis->result;
}

/// Whether two rays of a beam meet different surfaces.
bool RayReturns::is_edge(const Hit& on_axis, const Hit& aside) {
  return std::abs(on_axis.normal_world.dot(aside.point_world - on_axis.point_world)) > kEdgeStep;
}

Return RayReturns::at_edge(Return on_axis, Return aside, double share_aside) const {
  on_axis.echo.beam_share = 1.0 - share_aside;
  aside.echo.beam_share = share_aside;
  const double power = relative_power(config_, on_axis.echo);
  const double power_aside = relative_power(config_, aside.echo);
  Return stronger = power >= power_aside ? on_axis : aside;
  if (std::abs(on_axis.true_range - aside.true_range) > config_.range_resolution_m) {
    return stronger;
  }
  const double both = power + power_aside;
  const double w = both > 0.0 ? power_aside / both : share_aside;  // black surfaces have no power to compare
  stronger.kind = ReturnKind::kMixed;
  stronger.echo.range_m = (1.0 - w) * on_axis.true_range + w * aside.true_range;
  stronger.echo.beam_share = 1.0;
  stronger.doppler = (1.0 - w) * on_axis.true_doppler + w * aside.true_doppler;
  return stronger;
}

}  // namespace dynamic_icp::simulation
