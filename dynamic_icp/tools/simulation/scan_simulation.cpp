// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "dynamic_icp/tools/simulation/detection.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr std::size_t kFiringsPerBlock = 16;
constexpr double kRadians = std::numbers::pi / 180.0;

// A second surface in the beam is one of its own when it is off the plane of the first by more than this.
constexpr double kEdgeStep = 0.02;  // m

/// Streams of random numbers of one ray.
enum RayStream : std::uint64_t {
  kDropout,
  kRangeNoise,
  kDopplerNoise,
  kOutlier,
  kOutlierValue,
  kScatterAcross,
  kScatterUp,
  kBeamRadius,
  kBeamAngle,
  kBeamShare,
  kRain,
  kRainRange,
  kRainVelocity,  // three normal numbers
  kDetection = kRainVelocity + 3,
  kAngleNoiseAcross,
  kAngleNoiseUp
};

/// Sensor and bodies at the time of a firing.
struct Moment {
  double time_s = 0.0;
  world::MotionState sensor;
  std::vector<world::BodyAt> bodies;
};

/// Embree must not see a pose that is not finite.
void check_pose(const world::MotionState& motion, const char* whose, double time_s) {
  if (!motion.T_world_body.matrix().allFinite()) {
    throw std::invalid_argument(std::string("the pose of ") + whose + " is not finite at " + std::to_string(time_s) +
                                " s");
  }
}

Moment moment_at(const Surroundings& surroundings, double time_s) {
  Moment moment{time_s, surroundings.sensor(time_s), world::bodies_at(surroundings.world, time_s)};
  check_pose(moment.sensor, "the sensor", time_s);
  for (const world::BodyAt& body : moment.bodies) {
    check_pose(body.motion, "a moving body", time_s);
  }
  return moment;
}

/// What comes back along one ray, before the sensor measures it.
struct Return {
  Echo echo;
  double doppler = 0.0;     // m/s
  double true_range = 0.0;  // m; differs from the echo's where returns are mixed
  double true_doppler = 0.0;
  std::int32_t body = 0;
  ReturnKind kind = ReturnKind::kSurface;
};

/// Simulates one ray after the other.
class RayMeasurement {
 public:
  RayMeasurement(const Surroundings& surroundings, const FmcwLidarConfig& config)
      : surroundings_(surroundings), config_(config) {}

  /// Casts a ray at a moment and adds what the sensor makes of it to `scan`; nothing when there is no return.
  void add(SimulatedScan& scan, const Moment& moment, const PatternRay& ray, double firing_time_s,
           const RandomSource& random) const {
    const double azimuth = ray.azimuth_rad + scatter(random, kScatterAcross);
    const double elevation = ray.elevation_rad + scatter(random, kScatterUp);
    const std::optional<Return> found = find_return(moment, azimuth, elevation, random);
    if (!found || random.uniform(kDropout) < config_.dropout_rate ||
        !(random.uniform(kDetection) < found_probability(*found))) {
      return;
    }
    const double range = measured_range(*found, random);
    // Noise of a near return must not put it behind the sensor.
    if (range <= 0.0) {
      return;
    }
    const Eigen::Vector3d measured_direction =
        direction(azimuth + angle_noise(random, kAngleNoiseAcross), elevation + angle_noise(random, kAngleNoiseUp));
    scan.measured.points.emplace_back(range * measured_direction);
    scan.measured.doppler.push_back(measured_doppler(*found, random));
    scan.measured.times.push_back(firing_time_s);
    scan.reflectivity.push_back(static_cast<float>(found->echo.reflectivity));
    scan.intensity_db.push_back(intensity_db(*found));
    scan.lines.push_back(ray.line);
    scan.bodies.push_back(found->body);
    scan.kinds.push_back(found->kind);
    scan.true_range.push_back(found->true_range);
    scan.true_doppler.push_back(found->true_doppler);
  }

 private:
  struct Hit {
    Eigen::Vector3d point_world;
    Eigen::Vector3d normal_world;
    Return result;
  };

  [[nodiscard]] double scatter(const RandomSource& random, RayStream stream) const {
    return config_.scatter_deg > 0.0 ? kRadians * config_.scatter_deg * random.uniform(stream, -1.0, 1.0) : 0.0;
  }

  [[nodiscard]] double angle_noise(const RandomSource& random, RayStream stream) const {
    return config_.angle_noise_deg > 0.0 ? kRadians * config_.angle_noise_deg * random.normal(stream) : 0.0;
  }

  /// Rain is given as the share of drops that are seen.
  [[nodiscard]] double found_probability(const Return& found) const {
    return found.kind == ReturnKind::kRain ? 1.0 : detection_probability(config_, found.echo);
  }

  [[nodiscard]] float intensity_db(const Return& found) const {
    constexpr double kWeakest = 1e-12;
    return static_cast<float>(10.0 * std::log10(std::max(kWeakest, relative_power(config_, found.echo))));
  }

  [[nodiscard]] std::optional<Return> find_return(const Moment& moment, double azimuth, double elevation,
                                                  const RandomSource& random) const {
    const Eigen::Vector3d axis = direction(azimuth, elevation);
    std::optional<Hit> hit = cast(moment, axis);
    const double free_way = hit ? hit->result.true_range : config_.max_range_m;
    if (config_.rain_rate > 0.0 && random.uniform(kRain) < config_.rain_rate) {
      const double range = -config_.rain_range_m * std::log(1.0 - random.uniform(kRainRange));
      if (range >= config_.min_range_m && range < free_way) {
        return drop(moment, axis, range, random);
      }
    }
    std::optional<Return> found = hit ? std::optional(hit->result) : std::nullopt;
    if (config_.beam_divergence_mrad > 0.0) {
      found = over_the_beam(moment, hit, azimuth, elevation, random);
    }
    return found && found->true_range >= config_.min_range_m ? found : std::nullopt;
  }

  /// The surface that a ray of the beam meets.
  [[nodiscard]] std::optional<Hit> cast(const Moment& moment, const Eigen::Vector3d& direction_sensor) const {
    const Eigen::Isometry3d& T_world_sensor = moment.sensor.T_world_body;
    const world::Ray ray{T_world_sensor.translation(), T_world_sensor.linear() * direction_sensor, config_.max_range_m};
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
    result.echo = {surface->range_m, surface->reflectivity, std::abs(surface->normal_world.dot(ray.direction_world))};
    result.doppler = range_rate(ray.direction_world, velocity_point, moment.sensor);
    result.true_range = result.echo.range_m;
    result.true_doppler = result.doppler;
    return Hit{point_world, surface->normal_world, result};
  }

  /// A beam has a width: a second ray within it tells whether it falls on an edge. The part of the beam beside the edge
  /// is lost or meets another surface. Returns of two surfaces that the sensor resolves compete, the stronger is
  /// reported; others melt into one between them.
  [[nodiscard]] std::optional<Return> over_the_beam(const Moment& moment, const std::optional<Hit>& on_axis,
                                                    double azimuth, double elevation,
                                                    const RandomSource& random) const {
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
  [[nodiscard]] static bool is_edge(const Hit& on_axis, const Hit& aside) {
    return std::abs(on_axis.normal_world.dot(aside.point_world - on_axis.point_world)) > kEdgeStep;
  }

  [[nodiscard]] Return at_edge(Return on_axis, Return aside, double share_aside) const {
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

  /// A rain drop: it falls at 6 m/s and drifts by about 1 m/s any way.
  [[nodiscard]] static Return drop(const Moment& moment, const Eigen::Vector3d& direction_sensor, double range,
                                   const RandomSource& random) {
    const Eigen::Vector3d velocity_world(random.normal(kRainVelocity), random.normal(kRainVelocity + 1),
                                         -6.0 + random.normal(kRainVelocity + 2));
    Return result;
    result.kind = ReturnKind::kRain;
    result.body = kNoBody;
    result.echo = {range, 0.0, 1.0};
    result.true_range = range;
    result.true_doppler =
        range_rate(moment.sensor.T_world_body.linear() * direction_sensor, velocity_world, moment.sensor);
    result.doppler = result.true_doppler;
    return result;
  }

  [[nodiscard]] double measured_range(const Return& found, const RandomSource& random) const {
    const double range = found.echo.range_m + config_.range_noise_m * random.normal(kRangeNoise);
    return quantised(range, config_.range_step_m);
  }

  [[nodiscard]] double measured_doppler(const Return& found, const RandomSource& random) const {
    double doppler =
        found.doppler + config_.doppler_bias_mps + config_.doppler_noise_mps * random.normal(kDopplerNoise);
    if (random.uniform(kOutlier) < config_.doppler_outlier_rate) {
      doppler = random.uniform(kOutlierValue, -config_.doppler_outlier_span_mps, config_.doppler_outlier_span_mps);
    }
    return quantised(doppler, config_.doppler_step_mps);
  }

  static double quantised(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

  const Surroundings& surroundings_;
  const FmcwLidarConfig& config_;
};

template <class Value>
void append(std::vector<Value>& whole, const std::vector<Value>& part) {
  whole.insert(whole.end(), part.begin(), part.end());
}

void append(SimulatedScan& whole, const SimulatedScan& part) {
  append(whole.measured.points, part.measured.points);
  append(whole.measured.doppler, part.measured.doppler);
  append(whole.measured.times, part.measured.times);
  append(whole.reflectivity, part.reflectivity);
  append(whole.intensity_db, part.intensity_db);
  append(whole.lines, part.lines);
  append(whole.bodies, part.bodies);
  append(whole.kinds, part.kinds);
  append(whole.true_range, part.true_range);
  append(whole.true_doppler, part.true_doppler);
}

/// Number of the first ray of each firing: the key of its noise.
std::vector<std::size_t> first_rays(const ScanPattern& pattern) {
  std::vector<std::size_t> firsts;
  std::size_t rays = 0;
  for (const Firing& firing : pattern) {
    firsts.push_back(rays);
    rays += firing.rays.size();
  }
  return firsts;
}

}  // namespace

double range_rate(const Eigen::Vector3d& direction_world, const Eigen::Vector3d& velocity_point_world,
                  const world::MotionState& sensor) {
  return direction_world.dot(velocity_point_world - sensor.velocity_world);
}

SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const FmcwLidarConfig& config,
                            Stamp stamp, const RandomSource& noise, const Workers& workers) {
  const RayMeasurement measurement(surroundings, config);
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
      for (std::size_t i = 0; i < pattern[f].rays.size(); ++i) {
        measurement.add(parts[block], moment, pattern[f].rays[i], pattern[f].time_s, noise.fork(first_ray[f] + i));
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
