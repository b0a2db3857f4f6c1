// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/map_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/mapping/rotation_search.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_labels.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/map_agreement.hpp"
#include "dynamic_icp/method/odometry/rig_origin.hpp"
#include "dynamic_icp/method/registration/gauss_newton.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr std::size_t kVelocitySamples = 3;
constexpr std::size_t kPointBlock = 4096;

// 1/m^2, of a position that is known because the map begins with it.
constexpr double kExactPosition = 1e12;

// The standard deviation of patches from planes follows the last scans with this weight for the newest; below the least
// no surface is trusted.
constexpr double kModelSigmaGain = 0.2;
constexpr double kMinModelDeviation_m = 0.001;

// With the first turn known the first scan is deskewed and the second aligned again: each round leaves about
// a tenth of the error.
constexpr int kDeskewRounds = 4;
constexpr double kDeskewGate_m = 0.5;
constexpr double kDeskewGateGain = 0.5;
constexpr double kDeskewed_rad_s = 3e-4;  // moves the end of a sweep of 0.1 s by 0.002 degrees

// A displacement that is known no better is not known.
constexpr double kUnknown_m = 100.0;

motion::SweepMotion sweep_without_rotation(const ego_motion::EgoVelocity& ego, double middle_s) {
  motion::SweepMotion sweep;
  sweep.velocity = ego.velocity_sensor - middle_s * ego.acceleration_sensor;
  sweep.acceleration = ego.acceleration_sensor;
  return sweep;
}

double match(const mapping::MapAlignment& found) {
  return found.points > 0 ? found.matched / static_cast<double>(found.points) : 0.0;
}

/// Whether the alignment is worth nothing, given the usual share of points that agree.
bool is_lost(const mapping::MapAlignment& found, double min_match) {
  return found.diverged || match(found) < min_match ||
         found.matched < kMinAgreement * static_cast<double>(found.on_planes);
}

}  // namespace

MapOdometry::MapOdometry(const MapOdometryConfig& config, int threads, DopplerKind expected)
    : config_(checked(config)),
      workers_(threads),
      expected_(expected),
      map_(config.mapping),
      tracker_(config.tracking),
      stream_(config.stream) {}

std::vector<std::string> MapOdometry::assumptions() const {
  return expected_ == DopplerKind::kCompensated ? std::vector{compensated_doppler_note()} : std::vector<std::string>{};
}

Frame MapOdometry::process(const ScanView& raw) {
  Frame frame = process_at_middle(raw);
  return middle_ ? seen_from_origin(std::move(frame), *middle_) : frame;
}

Frame MapOdometry::process_at_middle(const ScanView& raw) {
  stream_.check_order(raw.stamp);
  Frame frame;
  StageClock clock(frame.times);
  thin_and_sort(raw, frame);
  clock.finish(Stage::kPreprocess);

  const FrameStatus found = stream_.add(raw.stamp, memory_.thinned.size());
  frame.status = found;
  if (is_skipped(found)) {
    if (state_) {
      predict_only(stream_.elapsed_s(), found, frame);
    }
    return frame;
  }
  ScanState now = separate_static_points();
  frame.ego = now.ego;
  clock.finish(Stage::kEgoMotion);

  if (found == FrameStatus::kFirst) {
    begin(now, Eigen::Isometry3d::Identity());
  } else if (found == FrameStatus::kTimeGap) {
    predict_only(now.stamp_s, found, frame);
    begin(now, frame.T_world_sensor);
  } else {
    if (!now.is_relative && state_->scans_in_map == 1) {
      now.ego = first_velocity(now);
    }
    update(now, frame);
  }
  if (!now.is_relative) {
    frame.ego = state_->filtered;
  }
  frame.twist = motion::twist_at_stamp(state_->rotation, frame.ego, now.middle_s);
  clock.finish(Stage::kRegistration);

  workers_.both([&] { frame.static_points = add_to_map(now); }, [&] { track_objects(frame); });
  clock.finish(Stage::kDynamics);
  return frame;
}

/// The scan in range, the rows that the voxel grid keeps, and its Doppler by cells.
void MapOdometry::thin_and_sort(const ScanView& raw, Frame& frame) {
  frame.sweep = motion::sweep_as_configured(raw, config_.sweep);
  const ScanView timed = motion::retimed(raw, config_.sweep, memory_.times);
  const Scan& whole = memory_.whole;
  assign(timed, config_.preprocess, workers_, memory_.whole, frame);
  if (whole.is_of_rig() && !state_) {
    middle_ = middle_of_sensors(whole);
  }
  if (middle_) {
    memory_.whole = whole.transformed(Eigen::Isometry3d(Eigen::Translation3d(-*middle_)));
  }
  workers_.both(
      [&] { preprocess::voxel_rows(whole, config_.preprocess.voxel, workers_, memory_.voxels, memory_.thinned); },
      [&] {
        ego_motion::sort_into_cells(whole, config_.ego_motion.consensus.cell_size_m, workers_, memory_.sort,
                                    memory_.rows);
      });
  frame.points_used = memory_.thinned.size();
}

/// A new map with this scan as its first, at a known place.
void MapOdometry::begin(const ScanState& now, const Eigen::Isometry3d& T_map_sensor) {
  map_.clear();
  State state;
  state.stamp_s = now.stamp_s;
  state.model_sigma_m = state_ ? state_->model_sigma_m : config_.map_align.model_sigma_m;
  state.filtered = now.filtered;
  state.T_map_sensor = T_map_sensor;
  state.position_information = kExactPosition * Eigen::Matrix3d::Identity();
  state.rotation = motion::first_rotation_state(config_.rotation);
  state.rotation.R_map_sensor = T_map_sensor.linear();
  state.sweep = sweep_without_rotation(now.ego, now.middle_s);
  if (now.rotation) {
    state.rotation = motion::fused(state.rotation, now.middle_s, *now.rotation);
    state.rotation.R_map_sensor = T_map_sensor.linear();
    state.sweep.omega = state.rotation.omega;
  }
  state.first = now;
  state.velocities = {
      {now.stamp_s + now.middle_s, now.ego.velocity_sensor, now.ego.covariance, state.rotation.R_map_sensor}};
  state_ = std::move(state);
}

std::vector<motion::VelocitySample> MapOdometry::velocities_with(const ScanState& now) const {
  std::vector<motion::VelocitySample> samples = state_->velocities;
  samples.push_back({now.stamp_s + now.middle_s, now.ego.velocity_sensor, now.ego.covariance, {}});
  if (samples.size() > kVelocitySamples) {
    samples.erase(samples.begin());
  }
  return samples;
}

/// Where the scan should be: the turn as it was expected, the way by the velocities of this and the last scans.
mapping::MotionPrior MapOdometry::motion_prior(const ScanState& now) const {
  const double dt_s = now.stamp_s - state_->stamp_s;
  motion::RotationState rotation = motion::predict(state_->rotation, dt_s, config_.rotation);
  if (now.rotation) {
    rotation = motion::fused(rotation, now.middle_s, *now.rotation);
  }
  mapping::MotionPrior prior;
  prior.R_map_sensor = rotation.R_map_sensor;
  prior.sweep = sweep_without_rotation(now.ego, now.middle_s);
  prior.sweep.omega = rotation.omega;
  prior.sweep.alpha = rotation.alpha;
  prior.covariance = rotation.covariance;
  if (!now.is_relative) {
    predict_constant_velocity(now, prior);
    return prior;
  }
  std::vector<motion::VelocitySample> samples = velocities_with(now);
  const Eigen::Matrix3d R_stamp_middle = prior.sweep.rotation(now.middle_s);
  samples.back().R_map_sensor = prior.R_map_sensor * R_stamp_middle;
  const motion::Displacement displacement = motion::displacement_between(samples, state_->stamp_s, now.stamp_s);
  prior.displacement_fixed = state_->T_map_sensor.translation() + displacement.fixed_map;
  prior.displacement_rotated = displacement.last_weight_s * (R_stamp_middle * now.ego.velocity_sensor);
  const double integration_m = config_.use_displacement ? config_.displacement_sigma_mps * dt_s : kUnknown_m;
  prior.translation_covariance = state_->position_covariance + displacement.covariance_map +
                                 integration_m * integration_m * Eigen::Matrix3d::Identity();
  return prior;
}

void MapOdometry::update(const ScanState& now, Frame& frame) {
  mapping::MapAlignConfig config = config_.map_align;
  config.model_sigma_m = state_->model_sigma_m;
  const mapping::MotionPrior prior = motion_prior(now);
  mapping::MapAlignment found = state_->scans_in_map == 1 ? align_second(now, prior)
                                : !now.is_relative
                                    ? align_with_found_velocity(now, prior, config)
                                    : mapping::align_to_map(now.static_points, map_, prior, config, workers_);
  const double min_match = std::max(kMinMatch, config_.lost_match * state_->usual_match);
  if (is_lost(found, min_match)) {
    found = mapping::search_and_align(now.static_points, map_, prior, config, workers_);
  }
  if (is_lost(found, min_match) || !is_plausible_motion(motion_to(found), now.stamp_s - state_->stamp_s)) {
    mark_lost(now, prior, frame);
    return;
  }
  const Eigen::Matrix3d observed = observed_position_information(now, found);
  if (!now.is_relative) {
    keep_predicted_where_unobservable(prior, observed, found);
  }
  const ego_motion::EgoVelocity moved = now.is_relative ? now.filtered : found_velocity(now, found, observed);
  const motion::RotationState expected =
      motion::predict(state_->rotation, now.stamp_s - state_->stamp_s, config_.rotation);
  const motion::RotationState rotation =
      motion::updated(mapping::rotation_state(found), expected, now.duration_s, config_.rotation);
  describe(prior, found, observed, rotation.covariance.topLeftCorner<3, 3>(),
           registration::typical_distance(now.static_points), frame);

  state_->usual_match = state_->scans_in_map == 1
                            ? match(found)
                            : state_->usual_match + kUsualMatchGain * (match(found) - state_->usual_match);
  if (found.model_sigma_m) {
    const double seen = std::max(kMinModelDeviation_m, *found.model_sigma_m);
    state_->model_sigma_m += kModelSigmaGain * (seen - state_->model_sigma_m);
  }
  state_->first = {};
  state_->stamp_s = now.stamp_s;
  state_->T_map_sensor = found.T_map_sensor;
  state_->rotation = rotation;
  state_->sweep = found.sweep;
  state_->filtered = moved;
  // The map is the mean of its last scans: a position drifts away from it only as long as it remembers.
  const double memory = config_.mapping.memory_scans;
  state_->position_covariance = memory / (memory + 1.0) * found.covariance.block<3, 3>(3, 3);
  state_->position_information = observed;
  std::vector<motion::VelocitySample> velocities = velocities_with(now);
  velocities.back().R_map_sensor = found.T_map_sensor.linear() * found.sweep.rotation(now.middle_s);
  state_->velocities = std::move(velocities);
}

/// What the frame says of an alignment.
void MapOdometry::describe(const mapping::MotionPrior& prior, const mapping::MapAlignment& found,
                           const Eigen::Matrix3d& observed, const Eigen::Matrix3d& rotation_covariance, double length_m,
                           Frame& frame) const {
  motion::MotionEvidence evidence;
  evidence.source_rotation_covariance = state_->rotation.covariance.topLeftCorner<3, 3>();
  evidence.target_rotation_covariance = rotation_covariance;
  evidence.displacement_covariance = prior.translation_covariance - state_->position_covariance;
  evidence.source_position_information = state_->position_information;
  evidence.target_position_information = observed;
  evidence.displacement_rotated = prior.displacement_rotated;
  registration::Alignment& alignment = frame.alignment;
  alignment.iterations = found.iterations;
  alignment.fitness = match(found);
  alignment.inlier_rmse = found.rms_m;
  alignment.correspondences = found.on_planes;
  alignment.geometry = {found.on_planes, static_cast<std::size_t>(found.matched), found.rms_m};
  alignment.length_m = length_m;
  alignment.covariance = motion::motion_covariance(evidence, found.T_map_sensor.linear());
  alignment.degenerate = motion::unobservable_directions(*alignment.covariance, length_m, config_.unobservable_sigma_m);
  alignment.information_ratio = motion::information_ratio(*alignment.covariance, length_m);
  alignment.T_target_source = found.T_map_sensor.inverse() * state_->T_map_sensor;
  alignment.status =
      found.converged ? registration::AlignStatus::kConverged : registration::AlignStatus::kIterationLimit;
  FrameStatus status = found.converged ? FrameStatus::kConverged : FrameStatus::kIterationLimit;
  if (!alignment.degenerate.empty()) {
    alignment.status = registration::AlignStatus::kDegenerate;
    status = FrameStatus::kDegenerate;
  }
  set_motion(frame, status, state_->T_map_sensor, alignment.T_target_source);
}

/// Nothing fits the map: the motion is the one expected, and the map begins anew.
void MapOdometry::mark_lost(const ScanState& now, const mapping::MotionPrior& prior, Frame& frame) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.linear() = prior.R_map_sensor;
  T_map_sensor.translation() = prior.displacement_fixed + prior.R_map_sensor * prior.displacement_rotated;
  set_motion(frame, FrameStatus::kLost, state_->T_map_sensor, T_map_sensor.inverse() * state_->T_map_sensor);
  motion::MotionEvidence evidence;
  evidence.target_rotation_covariance = prior.covariance.topLeftCorner<3, 3>();
  evidence.displacement_covariance = prior.translation_covariance - state_->position_covariance;
  evidence.displacement_rotated = prior.displacement_rotated;
  frame.alignment.covariance = motion::motion_covariance(evidence, prior.R_map_sensor);
  const motion::SweepMotion sweep = prior.sweep;
  begin(now, T_map_sensor);
  state_->rotation.omega = sweep.omega;
  state_->sweep.omega = sweep.omega;
}

/// The first scan was laid down as if the sensor did not turn. With the rotation that the second shows it is laid down
/// again, until both agree.
mapping::MapAlignment MapOdometry::align_second(const ScanState& now, const mapping::MotionPrior& prior) {
  mapping::MapAlignment found =
      config_.search_start ? mapping::search_and_align(now.static_points, map_, prior, config_.map_align, workers_)
                           : mapping::align_to_map(now.static_points, map_, prior, config_.map_align, workers_);
  if (!state_->first.static_points.has_times()) {
    return found;
  }
  const ScanState& first = state_->first;
  const double dt_s = now.stamp_s - first.stamp_s;
  double gate_m = kDeskewGate_m;
  for (int round = 0; round < kDeskewRounds; ++round, gate_m *= kDeskewGateGain) {
    const Eigen::Matrix3d R_first_now = state_->T_map_sensor.linear().transpose() * found.T_map_sensor.linear();
    const Eigen::Vector3d mean_omega = log_so3(R_first_now) / dt_s;
    if (round > 0 && (mean_omega - state_->sweep.omega).norm() < kDeskewed_rad_s) {
      break;
    }
    state_->sweep.omega = mean_omega;
    state_->rotation.omega = mean_omega;
    if (!now.is_relative) {
      state_->sweep.velocity = log_se3(motion_to(found)).tail<3>() / dt_s;
    }
    state_->velocities.back().R_map_sensor = state_->T_map_sensor.linear() * state_->sweep.rotation(first.middle_s);
    mapping::MotionPrior deskewed_prior = motion_prior(now);
    if (!now.is_relative) {
      deskewed_prior.sweep.velocity = state_->sweep.velocity;
    }
    map_.clear();
    state_->scans_in_map = 0;
    add_to_map(first);
    found = mapping::align_to_map(now.static_points, map_, deskewed_prior, found.T_map_sensor.linear(), gate_m,
                                  config_.map_align, workers_);
  }
  return found;
}

/// Returns the points that were added, in sensor axes at the stamp.
std::vector<Eigen::Vector3d> MapOdometry::add_to_map(const ScanState& now) {
  std::vector<Eigen::Vector3d> points = motion::deskewed_points(now.static_points, state_->sweep, workers_);
  std::vector<Eigen::Vector3d> in_map(points.size());
  workers_.for_each(points.size(), kPointBlock, [&](std::size_t i) { in_map[i] = state_->T_map_sensor * points[i]; });
  map_.add(in_map, state_->T_map_sensor.translation(), workers_);
  ++state_->scans_in_map;
  return points;
}

/// Tracks what moves, and labels the points.
void MapOdometry::track_objects(Frame& frame) {
  std::vector<tracking::TrackedObject> objects;
  if (config_.track_objects) {
    memory_.whole = motion::deskew(std::move(memory_.whole), state_->sweep, workers_);
    objects = tracker_.update(memory_.whole, memory_.radial, memory_.is_moving, frame.T_world_sensor, workers_);
  }
  describe_tracks(frame, memory_.whole, memory_.is_moving, memory_.thinned, std::move(objects), workers_);
}

}  // namespace dynamic_icp::odometry
