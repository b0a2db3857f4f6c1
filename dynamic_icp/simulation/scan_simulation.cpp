// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/scan_simulation.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace dynamic_icp::simulation {
namespace {

constexpr std::size_t kFiringsPerBlock = 16;

/// Streams of random numbers of one ray.
enum RayStream : std::uint64_t { kDropout, kRangeNoise, kDopplerNoise, kOutlier, kOutlierValue };

/// Sensor and bodies at the time of a firing.
struct Moment {
  double time_s = 0.0;
  MotionState sensor;
  std::vector<BodyAt> bodies;
};

/// Embree must not see a pose that is not finite.
void check_pose(const MotionState& motion, const char* whose, double time_s) {
  if (!motion.T_world_body.matrix().allFinite()) {
    throw std::invalid_argument(std::string("the pose of ") + whose + " is not finite at " + std::to_string(time_s) +
                                " s");
  }
}

Moment moment_at(const Surroundings& surroundings, double time_s) {
  Moment moment{time_s, surroundings.sensor(time_s), bodies_at(surroundings.world, time_s)};
  check_pose(moment.sensor, "the sensor", time_s);
  for (const BodyAt& body : moment.bodies) {
    check_pose(body.motion, "a moving body", time_s);
  }
  return moment;
}

struct Return {
  double range = 0.0;
  double doppler = 0.0;
  double true_range = 0.0;
  double true_doppler = 0.0;
  std::int32_t body = 0;
};

/// Adds to the truth what the sensor makes of it; empty when the return is lost.
std::optional<Return> measure(Return result, const FmcwLidarConfig& config, const RandomSource& random) {
  if (random.uniform(kDropout) < config.dropout_rate) {
    return std::nullopt;
  }
  result.range = result.true_range + config.range_noise_m * random.normal(kRangeNoise);
  result.doppler =
      result.true_doppler + config.doppler_bias_mps + config.doppler_noise_mps * random.normal(kDopplerNoise);
  if (random.uniform(kOutlier) < config.doppler_outlier_rate) {
    result.doppler = random.uniform(kOutlierValue, -config.doppler_outlier_span_mps, config.doppler_outlier_span_mps);
  }
  if (config.doppler_step_mps > 0.0) {
    result.doppler = config.doppler_step_mps * std::round(result.doppler / config.doppler_step_mps);
  }
  // Noise of a near return must not put it behind the sensor.
  return result.range > 0.0 ? std::optional(result) : std::nullopt;
}

/// The true return along a direction given in the sensor frame.
std::optional<Return> true_return(const Surroundings& surroundings, const Moment& moment,
                                  const Eigen::Vector3d& direction, const FmcwLidarConfig& config) {
  const Eigen::Isometry3d& T_world_sensor = moment.sensor.T_world_body;
  const Ray ray{T_world_sensor.translation(), T_world_sensor.linear() * direction, config.max_range_m};
  const std::optional<RayHit> hit = surroundings.caster.cast(ray, moment.bodies);
  if (!hit || hit->range_m < config.min_range_m) {
    return std::nullopt;
  }
  Return result;
  result.true_range = hit->range_m;
  Eigen::Vector3d velocity_point = Eigen::Vector3d::Zero();
  if (hit->body) {
    const Eigen::Vector3d point_world = ray.origin_world + hit->range_m * ray.direction_world;
    velocity_point = point_velocity(moment.bodies[*hit->body].motion, point_world);
    result.body = surroundings.world.bodies[*hit->body].id;
  }
  result.true_doppler = range_rate(ray.direction_world, velocity_point, moment.sensor);
  return result;
}

/// The part of a scan that one block of firings makes.
void append(SimulatedScan& scan, const Return& result, const Eigen::Vector3d& direction, double time_s) {
  scan.measured.points.emplace_back(result.range * direction);
  scan.measured.doppler.push_back(result.doppler);
  scan.measured.times.push_back(time_s);
  scan.bodies.push_back(result.body);
  scan.true_range.push_back(result.true_range);
  scan.true_doppler.push_back(result.true_doppler);
}

template <class Value>
void append(std::vector<Value>& whole, const std::vector<Value>& part) {
  whole.insert(whole.end(), part.begin(), part.end());
}

void append(SimulatedScan& whole, const SimulatedScan& part) {
  append(whole.measured.points, part.measured.points);
  append(whole.measured.doppler, part.measured.doppler);
  append(whole.measured.times, part.measured.times);
  append(whole.bodies, part.bodies);
  append(whole.true_range, part.true_range);
  append(whole.true_doppler, part.true_doppler);
}

/// Number of the first ray of each firing: the key of its noise.
std::vector<std::size_t> first_rays(const ScanPattern& pattern) {
  std::vector<std::size_t> firsts;
  std::size_t rays = 0;
  for (const Firing& firing : pattern) {
    firsts.push_back(rays);
    rays += firing.directions.size();
  }
  return firsts;
}

}  // namespace

double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const MotionState& sensor) {
  return direction_world.dot(velocity_point_world - sensor.velocity_world);
}

SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const FmcwLidarConfig& config,
                            Stamp stamp, const RandomSource& noise, const Workers& workers) {
  const std::vector<std::size_t> first_ray = first_rays(pattern);
  const double scan_time_s = seconds_between(Stamp{}, stamp);
  std::vector<SimulatedScan> parts(Workers::block_count(pattern.size(), kFiringsPerBlock));
  workers.for_blocks(pattern.size(), kFiringsPerBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    Moment moment = moment_at(surroundings, scan_time_s + pattern[begin].time_s);
    for (std::size_t f = begin; f < end; ++f) {
      const double time_s = scan_time_s + pattern[f].time_s;
      if (time_s != moment.time_s) {
        moment = moment_at(surroundings, time_s);
      }
      for (std::size_t i = 0; i < pattern[f].directions.size(); ++i) {
        const Eigen::Vector3d& direction = pattern[f].directions[i];
        const std::optional<Return> truth = true_return(surroundings, moment, direction, config);
        const std::optional<Return> result =
            truth ? measure(*truth, config, noise.fork(first_ray[f] + i)) : std::nullopt;
        if (result) {
          append(parts[block], *result, direction, pattern[f].time_s);
        }
      }
    }
  });
  SimulatedScan scan;
  scan.measured.stamp = stamp;
  for (const SimulatedScan& part : parts) {
    append(scan, part);
  }
  return scan;
}

}  // namespace dynamic_icp::simulation
