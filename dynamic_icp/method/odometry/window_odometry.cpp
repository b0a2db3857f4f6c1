// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/window_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/ego_motion/support_plane.hpp"
#include "dynamic_icp/method/mapping/pose_search.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"
#include "dynamic_icp/method/motion/twist.hpp"
#include "dynamic_icp/method/odometry/compensated_motion.hpp"
#include "dynamic_icp/method/odometry/frame_labels.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"
#include "dynamic_icp/method/registration/gauss_newton.hpp"
#include "dynamic_icp/method/registration/translation_search.hpp"

namespace dynamic_icp::odometry {
namespace {

// No sensor sweeps for longer.
constexpr double kMaxSweep_s = 0.5;

// The velocity of traffic that may be followed for that of the sensor, m/s.
constexpr double kTraffic_mps = 3.0;

// What static points see of the difference between the velocity that was found and that of the Doppler alone, which
// differ by what the sensor errs: a city with all errors 0.3, a tunnel 0.6 m/s. More is a motion that has left the
// scene.
constexpr double kLargestDifference_mps = 1.0;

// Fewer agree with a map only by chance: of the points on its patches, and of all. A sparse radar meets few patches in
// the map of one scan (2 % of its points agree), and fits those well.
constexpr double kMinAgreement = 0.2;
constexpr double kMinMatch = 0.01;

// The usual share of points that agree with the map follows the last scans with this weight for the newest.
constexpr double kUsualMatchGain = 0.2;

// Where less of the second scan fits the map of the first, one scan alone makes no map.
constexpr double kMapOfOneScan = 0.1;

// How fast a sensor may turn of which nothing is known, and how far its second scan may be from where the first
// velocity leads.
constexpr double kSecondOmega_rad_s = 0.5;
constexpr double kSecondPosition_m = 0.05;
constexpr double kSearchedPosition_m = 0.2;  // where no Doppler tells

double match(const window::WindowMotion& motion) {
  return motion.points > 0 ? motion.planes.matched / static_cast<double>(motion.points) : 0.0;
}

}  // namespace

WindowOdometry::WindowOdometry(const WindowOdometryConfig& config, const SensorContext& context, int threads)
    : config_(checked(config)),
      workers_(threads),
      expected_(context.doppler_kind),
      map_(config.mapping),
      estimator_(config.window),
      tracker_(config.tracking),
      stream_(config.stream),
      clear_scans_(kClearScans) {
  if (context.calibration) {
    estimator_.set_calibration(*context.calibration);
  }
}

std::optional<window::SensorCalibration> WindowOdometry::calibration() const { return estimator_.calibration(); }

std::vector<std::string> WindowOdometry::assumptions() const {
  return expected_ == DopplerKind::kCompensated ? std::vector{compensated_doppler_note()} : std::vector<std::string>{};
}

Frame WindowOdometry::process(const ScanView& raw) {
  stream_.check_order(raw.stamp);
  Frame frame;
  StageClock clock(frame.times);
  thin_and_sort(raw, frame);
  clock.finish(Stage::kPreprocess);

  const FrameStatus found = stream_.add(raw.stamp, memory_.thinned.size());
  frame.status = found;
  if (is_skipped(found)) {
    if (estimator_.scans() > 0) {
      predict_only(stream_.elapsed_s(), found, frame);
    }
    return frame;
  }
  const double stamp_s = stream_.elapsed_s();
  separate_static_points();
  const window::WindowScan now = scan_at(stamp_s);
  clock.finish(Stage::kEgoMotion);

  if (found == FrameStatus::kFirst) {
    begin(now, Eigen::Isometry3d::Identity(), start_omega());
  } else if (found == FrameStatus::kTimeGap) {
    predict_only(stamp_s, found, frame);
    begin(now, frame.T_world_sensor, start_omega());
  } else if (was_misled()) {
    begin_again(now, frame);
  } else {
    update(now, frame);
  }
  T_world_sensor_ = frame.T_world_sensor;
  stamp_s_ = stamp_s;
  judge_points(now);
  frame.ego = ego_;
  clock.finish(Stage::kRegistration);

  window::WindowScan placed = now;
  placed.stamp_s = estimator_.stamp_s();
  frame.static_points = estimator_.add_to_map(placed, map_, workers_);
  track_objects(now, frame);
  clock.finish(Stage::kDynamics);
  return frame;
}

/// A driver may forget the mountings of a rig now and then: those of the scan before hold on.
ScanView WindowOdometry::with_mountings(ScanView raw) const {
  const auto largest = std::ranges::max_element(raw.sensor);
  if (raw.mountings.empty() && largest != raw.sensor.end() && *largest < mountings_.size()) {
    raw.mountings = mountings_;
  }
  return raw;
}

/// The scan in range without the error of its Doppler that is known, the rows that the voxel grid keeps, and its
/// Doppler by cells.
void WindowOdometry::thin_and_sort(const ScanView& raw, Frame& frame) {
  frame.sweep = motion::sweep_as_configured(raw, config_.sweep);
  ScanView timed = motion::retimed(with_mountings(raw), config_.sweep, memory_.times);
  Scan& whole = memory_.whole;
  assign(timed, config_.preprocess, workers_, whole, frame);
  if (const motion::TimeSpan span = motion::time_span(whole); span.last - span.first > kMaxSweep_s) {
    frame.dropped = {};
    timed.times = {};  // no sweep of a moving sensor: the trajectory would have thousands of knots
    assign(timed, config_.preprocess, workers_, whole, frame);
  }
  if (whole.is_of_rig()) {
    mountings_ = whole.mountings();
  }
  memory_.measured = whole.doppler();
  workers_.both(
      [&] { preprocess::voxel_rows(whole, config_.preprocess.voxel, workers_, memory_.voxels, memory_.thinned); },
      [&] {
        estimator_.sort(whole, workers_);
        estimator_.field_errors(whole, workers_, memory_.errors);
        workers_.for_each(whole.size(), kPointBlock,
                          [&](std::size_t i) { whole.shift_doppler(i, -memory_.errors.credible[i]); });
        take_out_lever_arms();
        ego_motion::sort_into_cells(whole, config_.ego_motion.consensus.cell_size_m, workers_, memory_.sort,
                                    memory_.rows);
        support_ = config_.find_support ? ego_motion::find_support_plane(whole, memory_.sort) : std::nullopt;
        memory_.rows.on_support =
            support_ ? ego_motion::cells_on_support(whole, memory_.sort, *support_) : std::vector<std::uint8_t>{};
      });
  frame.points_used = memory_.thinned.size();
}

window::WindowScan WindowOdometry::scan_at(double stamp_s) const {
  window::WindowScan scan;
  const motion::TimeSpan span = motion::time_span(memory_.whole);
  scan.stamp_s = stamp_s;
  scan.begin_s = span.first;
  scan.end_s = span.last;
  scan.whole = &memory_.whole;
  scan.measured = memory_.whole.doppler_kind() == DopplerKind::kRelative ? &memory_.measured : nullptr;
  scan.is_moving = &memory_.is_moving;
  scan.static_points = &static_points_;
  return scan;
}

void WindowOdometry::begin(const window::WindowScan& now, const Eigen::Isometry3d& T_map_sensor,
                           const window::StartOmega& omega) {
  map_.clear();
  is_map_renewed_ = false;
  usual_match_ = 0.0;
  estimator_.begin(now, T_map_sensor, ego_.velocity_sensor, omega, workers_);
  first_points_ = static_points_;
}

/// Before the first scan in a map.
window::StartOmega WindowOdometry::start_omega() const {
  return {lever_arm_omega_.value_or(Eigen::Vector3d::Zero()), config_.window.start_omega_rad_s};
}

/// Where the second scan is: its rotation is not known yet.
std::optional<Eigen::Isometry3d> WindowOdometry::search_second(const window::WindowScan& now) const {
  const double dt_s = now.stamp_s - estimator_.stamp_s();
  const Eigen::Isometry3d T_map_last = estimator_.trajectory().pose(estimator_.stamp_s());
  mapping::PosePrior prior;
  prior.sweep.omega = estimator_.trajectory().at_end().omega;  // the first scan was deskewed by it
  prior.R_map_sensor = T_map_last.linear() * exp_so3(dt_s * prior.sweep.omega);
  prior.rotation_sigma_rad = kSecondOmega_rad_s * dt_s;
  prior.sweep.velocity = ego_.velocity_sensor - ego_.reference_time_s * ego_.acceleration_sensor;
  prior.sweep.acceleration = ego_.acceleration_sensor;
  prior.position_sigma_m = kSecondPosition_m;
  if (now.measured == nullptr) {
    const registration::PreparedTarget target = registration::search_target(static_points_, workers_);
    const registration::InitialTranslation translation =
        registration::search_translation(first_points_, target.target(), dt_s, {}, workers_);
    if (!translation.is_unambiguous) {
      return std::nullopt;
    }
    prior.sweep.velocity = motion::mean_twist(translation.T_target_source.inverse(), dt_s).tail<3>();
    prior.position_sigma_m = kSearchedPosition_m;
  }
  const Eigen::Vector3d half = 0.5 * dt_s * prior.sweep.velocity;
  prior.displacement_fixed = T_map_last * half;
  prior.displacement_rotated = half;
  const mapping::FoundPose found = mapping::search_pose(*now.static_points, map_, prior, workers_);
  if (found.diverged || found.matched < kMinAgreement * static_cast<double>(found.on_planes)) {
    return std::nullopt;
  }
  return found.T_map_sensor;
}

/// The map, the objects and what is known of the sensor begin anew with the scan at hand.
void WindowOdometry::begin_again(const window::WindowScan& now, Frame& frame) {
  set_lost(estimator_.trajectory().at_end(), now.stamp_s - estimator_.stamp_s(), frame);
  estimator_ = window::WindowEstimator(config_.window);
  estimator_.sort(memory_.whole, workers_);
  estimator_.field_errors(memory_.whole, workers_, memory_.errors);
  begin(now, frame.T_world_sensor, start_omega());
  tracker_.forget();
}

void WindowOdometry::update(const window::WindowScan& now, Frame& frame) {
  std::optional<Eigen::Isometry3d> start;
  if (estimator_.scans() == 1 && config_.search_start) {
    start = search_second(now);
  }
  const window::TrajectoryPoint last = estimator_.trajectory().at_end();
  const double dt_s = now.stamp_s - estimator_.stamp_s();
  const bool is_second = estimator_.scans() == 1;
  const auto is_believed = [&](const window::WindowMotion& found) {
    return match(found) >= std::max(kMinMatch, config_.lost_match * usual_match_) &&
           found.planes.matched >= kMinAgreement * static_cast<double>(found.planes.on_planes) &&
           is_plausible_motion(found.T_target_source, dt_s) && is_borne_out(now);
  };
  const window::WindowMotion motion = estimator_.update(now, first_points_, map_, start, is_believed, workers_);
  if (motion.diverged || !is_believed(motion)) {
    set_lost(last, dt_s, frame);
    begin(now, frame.T_world_sensor, {last.omega, config_.window.start_omega_rad_s});
    return;
  }
  usual_match_ = is_second ? match(motion) : usual_match_ + kUsualMatchGain * (match(motion) - usual_match_);
  first_points_ = {};
  describe(motion, dt_s, frame);
  renew_bent_map(now, is_second, frame);
}

/// The motion that is expected, `dt_s` after the last scan.
void WindowOdometry::set_lost(const window::TrajectoryPoint& last, double dt_s, Frame& frame) const {
  const Eigen::Isometry3d predicted = motion::motion_of(last.omega, ego_.velocity_sensor, -dt_s);
  set_motion(frame, FrameStatus::kLost, T_world_sensor_, predicted);
  frame.alignment.covariance = Matrix6d(Vector6d::Constant(dt_s * dt_s).asDiagonal());
}

/// Whether the Doppler of what stands bears out the velocity of the estimator, whose error field takes up any
/// difference.
bool WindowOdometry::is_borne_out(const window::WindowScan& now) const {
  using ego_motion::EgoVelocityStatus;
  if (now.measured == nullptr ||
      (ego_.status != EgoVelocityStatus::kConverged && ego_.status != EgoVelocityStatus::kIterationLimit)) {
    return true;
  }
  const double time_s = now.stamp_s + ego_.reference_time_s;
  const Eigen::Vector3d difference = estimator_.trajectory().at(time_s).velocity - ego_.velocity_sensor;
  double squares = 0.0;
  for (const Eigen::Vector3d& u : now.static_points->directions()) {
    squares += u.dot(difference) * u.dot(difference);
  }
  return squares <= kLargestDifference_mps * kLargestDifference_mps * static_cast<double>(now.static_points->size());
}

/// Where the second scan does not show how the first one turned, that one bends the map, and all that follow fit
/// themselves to it. The first scan whose rotation is known begins the map anew.
void WindowOdometry::renew_bent_map(const window::WindowScan& now, bool is_second, const Frame& frame) {
  const bool is_unknown = frame.status == FrameStatus::kDegenerate;
  if (is_second) {
    is_map_bent_ = is_unknown && !is_map_renewed_ && usual_match_ > kMapOfOneScan;
  } else if (is_map_bent_ && !is_unknown) {
    const motion::Twist twist = estimator_.twist();
    const double variance = twist.covariance.topLeftCorner<3, 3>().trace() / 3.0;
    begin(now, frame.T_world_sensor, {twist.angular, std::sqrt(variance)});
    is_map_bent_ = false;
    is_map_renewed_ = true;
  }
}

/// What the frame says of a motion.
void WindowOdometry::describe(const window::WindowMotion& motion, double dt_s, Frame& frame) const {
  registration::Alignment& alignment = frame.alignment;
  const double length_m = registration::typical_distance(static_points_);
  alignment.iterations = motion.iterations;
  alignment.fitness = match(motion);
  alignment.inlier_rmse = motion.planes.rms_m;
  alignment.correspondences = motion.planes.on_planes;
  alignment.geometry = {motion.planes.on_planes, static_cast<std::size_t>(motion.planes.matched), motion.planes.rms_m};
  alignment.length_m = length_m;
  alignment.covariance = motion.covariance;
  alignment.degenerate = motion::unobservable_directions(motion.covariance, length_m, config_.unobservable_sigma_m);
  alignment.information_ratio = motion::information_ratio(motion.covariance, length_m);
  alignment.T_target_source = motion.T_target_source;
  alignment.status =
      motion.converged ? registration::AlignStatus::kConverged : registration::AlignStatus::kIterationLimit;
  FrameStatus status = motion.converged ? FrameStatus::kConverged : FrameStatus::kIterationLimit;
  if (clear_scans_ < kClearScans) {
    status = FrameStatus::kAmbiguous;
    const double sigma_m = kTraffic_mps * dt_s;
    alignment.covariance->bottomRightCorner<3, 3>().diagonal().array() += sigma_m * sigma_m;
  }
  if (!alignment.degenerate.empty()) {
    alignment.status = registration::AlignStatus::kDegenerate;
    status = FrameStatus::kDegenerate;
  }
  set_motion(frame, status, T_world_sensor_, motion.T_target_source);
}

/// A scan that cannot be used, or one after a long gap: the last motion continues.
void WindowOdometry::predict_only(double stamp_s, FrameStatus status, Frame& frame) const {
  const double dt_s = std::min(stamp_s - stamp_s_, kMaxPrediction_s);
  const window::TrajectoryPoint last = estimator_.trajectory().at(estimator_.stamp_s());
  set_motion(frame, status, T_world_sensor_, motion::motion_of(last.omega, last.velocity, -dt_s));
  const double turned_rad = kSecondOmega_rad_s * dt_s;
  const double moved_m = 0.5 * kUnmodelledAcceleration_mps2 * dt_s * dt_s;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(turned_rad * turned_rad);
  covariance.diagonal().tail<3>().setConstant(moved_m * moved_m);
  frame.alignment.covariance = covariance;
}

/// The trajectory during the scan as an even acceleration.
motion::SweepMotion WindowOdometry::sweep_of(const window::WindowScan& now) const {
  const window::SplineTrajectory& trajectory = estimator_.trajectory();
  motion::SweepMotion sweep;
  const double stamp_s = estimator_.stamp_s();
  const window::TrajectoryPoint at = trajectory.at(stamp_s);
  sweep.omega = at.omega;
  sweep.velocity = at.velocity;
  const double duration_s = now.end_s - now.begin_s;
  if (duration_s > 0.0) {
    const window::TrajectoryPoint begin = trajectory.at(stamp_s + now.begin_s);
    const window::TrajectoryPoint end = trajectory.at(stamp_s + now.end_s);
    sweep.alpha = (end.omega - begin.omega) / duration_s;
    sweep.acceleration = (end.velocity - begin.velocity) / duration_s;
  }
  return sweep;
}

void WindowOdometry::track_objects(const window::WindowScan& now, Frame& frame) {
  std::span<const tracking::TrackedObject> objects;
  const motion::SweepMotion sweep = sweep_of(now);
  frame.twist = estimator_.twist();
  if (config_.track_objects) {
    tracker_.clear_carrier(memory_.whole, memory_.patches, memory_.may_be_object);
    memory_.whole = motion::deskew(std::move(memory_.whole), sweep, workers_);
    objects = tracker_.update(memory_.whole, memory_.radial, memory_.may_be_object,
                              tracking::motion_at(frame.T_world_sensor, sweep.omega, sweep.velocity), support_,
                              workers_, ego_.covariance, &memory_.patches);
    estimator_.learn_from(measured_bodies(objects, sweep, frame.T_world_sensor), workers_);
  }
  describe_tracks(frame, memory_.whole, memory_.is_moving, memory_.thinned, objects, workers_);
}

/// The scan at hand is none of it, but for the first one in a map.
void WindowOdometry::state(StateArchive& archive) {
  archive(mountings_, map_, estimator_, first_points_, tracker_, stream_, T_world_sensor_, stamp_s_, usual_match_,
          is_map_bent_, is_map_renewed_, clear_scans_);
  constexpr double kLargestStampError_s = 1.0;
  archive.require(
      stream_.has_begun() == (estimator_.scans() > 0) &&
          (!stream_.has_begun() || (std::abs(estimator_.stamp_s() - stream_.last_usable_s()) <= kLargestStampError_s &&
                                    stamp_s_ == stream_.last_usable_s())),
      "the time of the last scan");
  archive.require(!tracker_.last_stamp() || stream_.is_past(*tracker_.last_stamp()), "the time of the objects");
  archive.require(mountings_.size() <= kMaxSensors && clear_scans_ >= 0 && clear_scans_ <= kClearScans,
                  "the state between two scans");
}

}  // namespace dynamic_icp::odometry
