// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/scan_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamic_icp/tools/simulation/random_streams.hpp"
#include "dynamic_icp/tools/simulation/units.hpp"

namespace dynamic_icp::simulation {
namespace {

constexpr std::size_t kFiringsPerBlock = 16;

/// What the rays of one instant have in common.
struct FiringState {
  Moment moment;
  double time_in_scan_s = 0.0;
  double doppler_noise_mps = 0.0;  ///< of the scan and of the firing
};

/// Calls `action` with each column of `to` and the same one of `from`.
template <class Action>
void for_columns(SimulatedScan& to, const SimulatedScan& from, const Action& action) {
  action(to.measured.points, from.measured.points);
  action(to.measured.doppler, from.measured.doppler);
  action(to.measured.times, from.measured.times);
  action(to.reflectivity, from.reflectivity);
  action(to.intensity_db, from.intensity_db);
  action(to.lines, from.lines);
  action(to.beams, from.beams);
  action(to.faces, from.faces);
  action(to.bodies, from.bodies);
  action(to.kinds, from.kinds);
  action(to.true_range, from.true_range);
  action(to.true_doppler, from.true_doppler);
  action(to.systematic_error, from.systematic_error);
}

/// Simulates one ray after the other.
class RayMeasurement {
 public:
  RayMeasurement(const Surroundings& surroundings, const SensorUnit& unit, const ScanOfDrive& which)
      : unit_(unit),
        config_(unit.config),
        which_(which),
        returns_(surroundings, unit.config),
        face_of_scan_(config_.face_per_scan ? which.index % static_cast<std::size_t>(config_.faces) : 0) {}

  /// Casts a ray and adds what the sensor makes of it to `scan`; nothing when there is no return.
  void add(SimulatedScan& scan, const FiringState& firing, const PatternRay& ray, const RandomSource& random) const {
    const double azimuth = ray.azimuth_rad + scatter(random, kScatterAcross);
    const double elevation = ray.elevation_rad + scatter(random, kScatterUp);
    if (is_blind(azimuth)) {
      return;
    }
    const std::optional<Return> found = returns_.find(firing.moment, azimuth, elevation, random);
    if (!found || random.uniform(kDropout) < config_.dropout_rate ||
        !(random.uniform(kDetection) < found_probability(*found))) {
      return;
    }
    const std::size_t face = ray.face + face_of_scan_;
    const PointingOffset pointing = unit_.pointing.at(ray.line, ray.beam, face);
    const double range = measured_range(*found, pointing.range_m, random);
    // Noise of a near return must not put it behind the sensor.
    if (range <= 0.0) {
      return;
    }
    const Eigen::Vector3d measured_direction =
        direction(azimuth + (angle_noise(random, kAngleNoiseAcross) + pointing.azimuth_rad),
                  elevation + (angle_noise(random, kAngleNoiseUp) + pointing.elevation_rad));
    const double power = relative_power(config_, found->echo);
    const double power_db = intensity_db(power);
    const DopplerCause cause{ray.line,
                             ray.beam,
                             face,
                             azimuth,
                             elevation,
                             found->echo.range_m,
                             found->echo.cos_incidence,
                             power_db,
                             found->doppler,
                             firing.moment.time_s};
    const double systematic = unit_.doppler.systematic_mps(cause) + which_.doppler_drift_mps + config_.doppler_bias_mps;
    scan.measured.points.emplace_back(range * measured_direction);
    scan.measured.doppler.push_back(measured_doppler(*found, systematic, noise_mps(*found, power), firing, random));
    scan.measured.times.push_back(firing.time_in_scan_s + config_.timing.point_time_offset_s);
    scan.reflectivity.push_back(static_cast<float>(found->echo.reflectivity));
    scan.intensity_db.push_back(static_cast<float>(power_db));
    scan.lines.push_back(ray.line);
    scan.beams.push_back(ray.beam);
    scan.faces.push_back(static_cast<std::uint8_t>(face));
    scan.bodies.push_back(found->body);
    scan.kinds.push_back(found->kind);
    scan.true_range.push_back(found->true_range);
    scan.true_doppler.push_back(found->true_doppler);
    scan.systematic_error.push_back(systematic);
    if (config_.duplicate_rate > 0.0 && random.uniform(kDuplicate) < config_.duplicate_rate) {
      for_columns(scan, scan, [](auto& to, const auto& from) { to.push_back(from.back()); });
    }
  }

 private:
  [[nodiscard]] double scatter(const RandomSource& random, RayStream stream) const {
    return config_.scatter_deg > 0.0 ? kRadians * config_.scatter_deg * random.uniform(stream, -1.0, 1.0) : 0.0;
  }

  [[nodiscard]] double angle_noise(const RandomSource& random, RayStream stream) const {
    return config_.angle_noise_deg > 0.0 ? kRadians * config_.angle_noise_deg * random.normal(stream) : 0.0;
  }

  /// From the right end of the sector to the left one; a sector may hold the backward direction.
  [[nodiscard]] bool is_blind(double azimuth) const {
    if (config_.blind_from_deg == config_.blind_to_deg) {
      return false;
    }
    const auto turned = [&](double angle_deg) {
      const double angle = angle_deg - config_.blind_from_deg;
      return angle - 360.0 * std::floor(angle / 360.0);
    };
    return turned(azimuth / kRadians) < turned(config_.blind_to_deg);
  }

  /// Drops and the window are given as the share of them that is seen.
  [[nodiscard]] double found_probability(const Return& found) const {
    const bool certain =
        found.kind == ReturnKind::kRain || found.kind == ReturnKind::kSpray || found.kind == ReturnKind::kWindow;
    return certain ? 1.0 : detection_probability(config_, found.echo);
  }

  [[nodiscard]] static double intensity_db(double power) {
    constexpr double kWeakest = 1e-12;
    return 10.0 * std::log10(std::max(kWeakest, power));
  }

  [[nodiscard]] double noise_mps(const Return& found, double power) const {
    const double power_at_detection_range = 1.0 / (config_.detection_range_m * config_.detection_range_m);
    return doppler_noise_mps(config_.doppler_error, config_.doppler_noise_mps, found.echo.range_m,
                             power / power_at_detection_range);
  }

  [[nodiscard]] double measured_range(const Return& found, double offset_m, const RandomSource& random) const {
    const double range = found.echo.range_m + (config_.range_noise_m * random.normal(kRangeNoise) + offset_m);
    return quantised(range, config_.range_step_m);
  }

  [[nodiscard]] double measured_doppler(const Return& found, double systematic, double sigma_mps,
                                        const FiringState& firing, const RandomSource& random) const {
    const double noise = sigma_mps * random.normal(kDopplerNoise) + firing.doppler_noise_mps;
    double doppler = found.doppler + systematic + noise;
    if (random.uniform(kOutlier) < config_.doppler_outlier_rate) {
      doppler = random.uniform(kOutlierValue, -config_.doppler_outlier_span_mps, config_.doppler_outlier_span_mps);
    }
    return quantised(wrapped(doppler, config_.doppler_error.ambiguity_mps), config_.doppler_step_mps);
  }

  static double quantised(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

  const SensorUnit& unit_;
  const FmcwLidarConfig& config_;
  const ScanOfDrive& which_;
  RayReturns returns_;
  std::size_t face_of_scan_;
};

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

/// The noise (m/s) that all rays of a firing have.
double common_noise(const DopplerErrorConfig& config, std::size_t firing, const RandomSource& noise) {
  double sum = config.scan_noise_mps > 0.0 ? config.scan_noise_mps * noise.normal(kScanDoppler) : 0.0;
  if (config.firing_noise_mps > 0.0) {
    sum += config.firing_noise_mps * noise.normal(kFiringDoppler + firing);
  }
  return sum;
}

}  // namespace

SimulatedScan simulate_scan(const Surroundings& surroundings, const ScanPattern& pattern, const SensorUnit& unit,
                            const ScanOfDrive& which, const RandomSource& noise, const Workers& workers) {
  const RayMeasurement measurement(surroundings, unit, which);
  const std::vector<std::size_t> first_ray = first_rays(pattern);
  const double scan_time_s = seconds_between(Stamp{}, which.begin);
  std::vector<SimulatedScan> parts(Workers::block_count(pattern.size(), kFiringsPerBlock));
  workers.for_blocks(pattern.size(), kFiringsPerBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    FiringState state;
    for (std::size_t f = begin; f < end; ++f) {
      const double time_s = scan_time_s + pattern[f].time_s;
      if (f == begin || time_s != state.moment.time_s) {
        state.moment = moment_at(surroundings, time_s);
      }
      state.time_in_scan_s = pattern[f].time_s;
      state.doppler_noise_mps = common_noise(unit.config.doppler_error, f, noise);
      for (std::size_t i = 0; i < pattern[f].rays.size(); ++i) {
        measurement.add(parts[block], state, pattern[f].rays[i], noise.fork(first_ray[f] + i));
      }
    }
  });
  SimulatedScan scan;
  scan.measured.stamp = which.begin;
  for (const SimulatedScan& part : parts) {
    for_columns(scan, part, [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); });
  }
  return scan;
}

}  // namespace dynamic_icp::simulation
