// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/recording/diagnosis/scan_matching.hpp"
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kStretch_s = 0.8;
constexpr std::size_t kMaxSteps = 12;
constexpr std::size_t kUnknownSteps = 6;
constexpr double kMinPeriod_s = 0.005;
constexpr double kMaxPeriod_s = 2.0;
constexpr std::size_t kColumnScans = 3;

constexpr double kLongestTruthGap_s = 0.5;
constexpr double kShortTranslation_m = 0.8;  // errors of some centimetres count too much
constexpr double kLongTranslation_m = 2.5;   // beyond, what is seen changes
constexpr double kAgreed = 0.15;

double median_period(const datasets::Dataset& dataset, std::size_t begin, std::size_t end) {
  std::vector<double> periods;
  for (std::size_t i = begin + 1; i < end; ++i) {
    periods.push_back(seconds_between(dataset.stamp(i - 1), dataset.stamp(i)));
  }
  return quantile(std::move(periods), 0.5);
}

/// How many scans a stretch is long.
std::size_t stretch_steps(double period_s, std::size_t scans) {
  const bool plausible = period_s > kMinPeriod_s && period_s < kMaxPeriod_s;
  std::size_t steps = plausible ? static_cast<std::size_t>(std::lround(kStretch_s / period_s)) : kUnknownSteps;
  steps = std::clamp<std::size_t>(steps, 2, kMaxSteps);
  steps -= steps % 2;
  return std::min(steps, scans - 1);
}

/// A scan of a stretch.
struct Seen {
  ScanLook look;
  Scan still;
};

/// The scans of a stretch: its first, the one after, the middle and the last.
struct Stretch {
  Seen first;
  Seen second;
  Seen middle;
  Seen last;
};

double dt_between(const Seen& a, const Seen& b) { return seconds_between(a.look.stamp, b.look.stamp); }

/// The way by the Doppler from one scan to another, in the axes of the first: the velocities on the way with their
/// weights, turned evenly by what the reference turns.
void add_doppler_translation(Motion& motion, std::span<const Seen* const> on_the_way, std::span<const double> weights) {
  motion.has_doppler = true;
  const Eigen::Vector3d turn = log_so3(motion.T_from_to.linear());
  for (std::size_t k = 0; k < on_the_way.size(); ++k) {
    const Seen& seen = *on_the_way[k];
    motion.has_doppler = motion.has_doppler && seen.look.has_velocity();
    const double share = motion.dt_s > 0.0 ? dt_between(*on_the_way[0], seen) / motion.dt_s : 0.0;
    motion.doppler_translation += weights[k] * motion.dt_s * (exp_so3(share * turn) * seen.look.ego.velocity_sensor);
  }
}

std::optional<Motion> motion_by_truth(const Stretch& stretch, const formats::Trajectory& truth) {
  // The velocities are those in the middle of the sweeps.
  const auto pose = [&](const Seen& seen) {
    return formats::pose_at(truth, {seen.look.stamp.ns + std::llround(1e9 * seen.look.ego.reference_time_s)},
                            kLongestTruthGap_s);
  };
  const std::optional<Eigen::Isometry3d> from = pose(stretch.first);
  const std::optional<Eigen::Isometry3d> to = pose(stretch.last);
  if (!from || !to) {
    return std::nullopt;
  }
  Motion motion;
  motion.T_from_to = from->inverse() * *to;
  motion.dt_s = dt_between(stretch.first, stretch.last);
  const double middle = dt_between(stretch.first, stretch.middle) / motion.dt_s;
  if (middle > 0.4 && middle < 0.6) {  // Simpson's rule
    add_doppler_translation(motion, std::array{&stretch.first, &stretch.middle, &stretch.last},
                            std::array{1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0});
  } else {
    add_doppler_translation(motion, std::array{&stretch.first, &stretch.last}, std::array{0.5, 0.5});
  }
  return motion;
}

std::vector<Eigen::Vector3d> search_axes(const Stretch& stretch) {
  const Eigen::Vector3d velocity = stretch.first.look.ego.velocity_sensor;
  if (stretch.first.look.has_velocity() && velocity.norm() > kStandsStill_mps) {
    return {velocity.normalized()};
  }
  return {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
}

std::optional<Motion> motion_by_matching(const Stretch& stretch, const Workers& workers) {
  const double step_s = dt_between(stretch.first, stretch.second);
  const std::optional<Eigen::Isometry3d> step =
      match_scans(stretch.first.still, stretch.second.still, step_s, search_axes(stretch), workers);
  if (!step) {
    return std::nullopt;
  }
  const auto way = [&](const Seen& to) { return step->translation().norm() * dt_between(stretch.first, to) / step_s; };
  const Seen* to = &stretch.second;
  if (way(*to) < kShortTranslation_m) {
    to = way(stretch.last) < kLongTranslation_m     ? &stretch.last
         : way(stretch.middle) < kLongTranslation_m ? &stretch.middle
                                                    : to;
  }
  Motion motion;
  motion.dt_s = dt_between(stretch.first, *to);
  motion.T_from_to = *step;
  if (to != &stretch.second) {
    const Eigen::Isometry3d T_start = exp_se3(motion.dt_s / step_s * log_se3(*step));
    const std::optional<Eigen::Isometry3d> farther =
        match_scans(stretch.first.still, to->still, step_s, T_start, workers);
    if (!farther) {
      return std::nullopt;
    }
    motion.T_from_to = *farther;
  }
  add_doppler_translation(motion, std::array{&stretch.first, to}, std::array{0.5, 0.5});
  return motion;
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

Comparison compare(const std::vector<Probe>& probes, std::optional<Motion> Probe::*which) {
  Comparison comparison;
  std::vector<double> reference_speeds;
  std::vector<double> doppler_speeds;
  std::vector<double> ratios;
  std::vector<double> angular_rates;
  std::vector<double> turned_deg;
  Eigen::Vector3d doppler_direction = Eigen::Vector3d::Zero();
  Eigen::Vector3d reference_direction = Eigen::Vector3d::Zero();
  for (const Probe& probe : probes) {
    const std::optional<Motion>& motion = probe.*which;
    if (!motion || !motion->has_doppler || !(motion->dt_s > 0.0)) {
      continue;
    }
    const Eigen::Vector3d way = motion->T_from_to.translation();
    reference_speeds.push_back(way.norm() / motion->dt_s);
    doppler_speeds.push_back(motion->doppler_translation.norm() / motion->dt_s);
    angular_rates.push_back(rotation_angle(motion->T_from_to.linear()) / motion->dt_s);
    if (reference_speeds.back() > kDirectionKnown_mps) {
      ratios.push_back(motion->doppler_translation.dot(way) / way.squaredNorm());
      reference_direction += way.normalized();
      doppler_direction += motion->doppler_translation.stableNormalized();
      turned_deg.push_back(angle_deg(way, motion->doppler_translation));
    }
  }
  comparison.motions = reference_speeds.size();
  comparison.moving = ratios.size();
  comparison.reference_speed_mps = quantile(reference_speeds, 0.5);
  comparison.doppler_speed_mps = quantile(doppler_speeds, 0.5);
  comparison.yaw_rate_rps = quantile(angular_rates, 0.5);
  if (!ratios.empty()) {
    comparison.ratio = quantile(ratios, 0.5);
    comparison.ratio_error = median_error(ratios);
    comparison.turned_error_deg = median_error(turned_deg);
    comparison.turned_deg = angle_deg(reference_direction, doppler_direction);
  }
  return comparison;
}

bool agrees(const Comparison& comparison) { return comparison.tells() && std::abs(comparison.ratio - 1.0) < kAgreed; }

/// The first scans of all stretches; a recording that is short has fewer.
std::vector<std::size_t> stretch_begins(const Evidence& evidence, std::size_t steps, std::size_t most) {
  const std::size_t places = evidence.end - evidence.begin - steps;
  const std::size_t count = std::min(most, places);
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < count; ++k) {
    begins.push_back(evidence.begin + (2 * k + 1) * places / (2 * count));
  }
  return begins;
}

Seen see(const Evidence& evidence, std::size_t index, const Workers& workers) {
  Seen seen;
  seen.look = look_at(prepared(evidence.dataset->scan(index), evidence.columns, evidence.units), workers, &seen.still);
  seen.look.stamp = evidence.dataset->stamp(index);
  return seen;
}

Stretch see_stretch(const Evidence& evidence, std::size_t begin, std::size_t steps, const Workers& workers) {
  return {see(evidence, begin, workers), see(evidence, begin + 1, workers), see(evidence, begin + steps / 2, workers),
          see(evidence, begin + steps, workers)};
}

void learn_columns(Evidence& evidence, const Workers& workers) {
  const std::size_t scans = evidence.end - evidence.begin;
  std::vector<RawScan> few;
  for (std::size_t k = 0; k < std::min(kColumnScans, scans); ++k) {
    few.push_back(evidence.dataset->scan(evidence.begin + (2 * k + 1) * scans / (2 * kColumnScans)));
  }
  evidence.columns = score_columns(few, workers);
  for (RawScan& scan : few) {
    scan = prepared(std::move(scan), evidence.columns, {});
  }
  evidence.units = guess_units(few);
}

}  // namespace

const Comparison* Evidence::reference() const {
  return matching.tells() ? &matching : truth.tells() ? &truth : nullptr;
}

bool Evidence::is_in_metres() const {
  return columns.doppler == 3 && !columns.spherical && units.points == 1.0 && units.doppler == 1.0;
}

double Evidence::median_of(double ScanLook::*value) const {
  std::vector<double> values;
  for (const ScanLook& look : looks) {
    values.push_back(look.*value);
  }
  return quantile(std::move(values), 0.5);
}

std::optional<double> Evidence::doppler_speed_mps() const {
  std::vector<double> speeds;
  for (const ScanLook& look : looks) {
    if (look.has_velocity()) {
      speeds.push_back(look.ego.velocity_sensor.norm());
    }
  }
  return speeds.empty() ? std::nullopt : std::optional(quantile(std::move(speeds), 0.5));
}

Evidence gather(const datasets::Dataset& dataset, const DiagnosisConfig& config, const Workers& workers) {
  Evidence evidence;
  evidence.dataset = &dataset;
  evidence.applied = config.applied;
  evidence.end = std::min(config.end, dataset.size());
  evidence.begin = std::min(config.begin, evidence.end);
  const std::size_t scans = evidence.end - evidence.begin;
  if (scans == 0) {
    return evidence;
  }
  evidence.period_s = median_period(dataset, evidence.begin, evidence.end);
  learn_columns(evidence, workers);
  if (scans < 3) {
    for (std::size_t i = evidence.begin; i < evidence.end; ++i) {
      evidence.looks.push_back(see(evidence, i, workers).look);
    }
    return evidence;
  }
  const std::size_t steps = stretch_steps(evidence.period_s, scans);
  const std::vector<std::size_t> begins = stretch_begins(evidence, steps, config.probes);
  const formats::Trajectory& truth = dataset.ground_truth();
  const auto add_matches = [&] {
    for (std::size_t k = 0; k < begins.size(); ++k) {
      if (!evidence.probes[k].match_was_tried) {
        evidence.probes[k].by_matching = motion_by_matching(see_stretch(evidence, begins[k], steps, workers), workers);
        evidence.probes[k].match_was_tried = true;
      }
    }
  };
  for (const std::size_t begin : begins) {
    const Stretch stretch = see_stretch(evidence, begin, steps, workers);
    Probe probe;
    probe.by_truth = motion_by_truth(stretch, truth);
    if (config.always_match_scans || truth.empty()) {
      probe.by_matching = motion_by_matching(stretch, workers);
      probe.match_was_tried = true;
    }
    evidence.probes.push_back(std::move(probe));
    for (const Seen* seen : {&stretch.first, &stretch.second, &stretch.middle, &stretch.last}) {
      evidence.looks.push_back(seen->look);
    }
  }
  evidence.truth = compare(evidence.probes, &Probe::by_truth);
  if (!agrees(evidence.truth)) {
    add_matches();
  }
  evidence.matching = compare(evidence.probes, &Probe::by_matching);
  if (config.search_sweep && evidence.is_in_metres()) {
    evidence.sweep = search_sweep(dataset, {evidence.begin, evidence.end}, evidence.period_s, workers);
  }
  return evidence;
}

}  // namespace dynamic_icp::diagnosis
