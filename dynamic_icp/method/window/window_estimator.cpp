// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "dynamic_icp/method/base/scan_limits.hpp"

namespace dynamic_icp::window {
namespace {

// The motion of so much time goes on evenly into the next scan.
constexpr double kEven_s = 0.1;

// Tukey's kernel of the planes, in standard deviations.
constexpr double kPlaneKernel = 4.0;

// A step shorter than this (rad and m) ends the iterations. The first of them reject no point of a surface for what is
// unknown of the pose.
constexpr double kStep = 1e-4;
constexpr int kMinIterations = 3;

// The second scan, which shows how the first one turned, may take so many times as many steps.
constexpr int kSecondTimes = 3;

// After a shorter one the Doppler need not be linearised anew: eliminating theta costs more than all the rest.
constexpr double kStraight = 1e-3;

// How often the Doppler is averaged anew, with weights around the trajectory of the moment; more often in the first
// scans of all, when the noise is not known.
constexpr int kPasses = 2;
constexpr int kFirstPasses = 3;
constexpr int kFirstScans = 3;
constexpr int kStartPasses = 10;  // until the scales of the error field have settled
// A motion that differs by less is the same for the points of a cell: they see 2 % of the difference.
constexpr double kSameVelocity_mps = 0.2;
constexpr double kSameOmega_rad_s = 0.05;

constexpr double kFirstGate_mps = 10.0;
constexpr double kGate_mps = 1.0;

// A scan is solved again when the variance of stamps or of errors of scans more than doubled, twice at most.
constexpr double kMuchNoise = 1.0;
constexpr int kNoiseRounds = 3;

// Faces of a mirror: one scan may show one of them only.
constexpr std::size_t kMaxFaces = 8;

// The first scans say how regular they come, not what was thought before.
constexpr double kUnknownPeriods = 0.02;

constexpr double kScanError_mps = 0.003;

}  // namespace

WindowEstimator::WindowEstimator(const WindowConfig& config)
    : config_(config),
      trajectory_(config.knot_spacing_s),
      motion_prior_(config),
      pointing_variance_(pointing_prior()),
      stamp_variance_(stamp_prior(config.start_stamp_sigma_s)),
      period_variance_(period_prior(kUnknownPeriod_s, kUnknownPeriods)),
      scan_error_variance_(scan_error_prior(kScanError_mps)),
      model_sigma_m_(config.model_sigma_m) {}

void WindowEstimator::sort(const Scan& whole, const Workers& workers) {
  cells_.sort(whole, config_.knot_spacing_s, workers);
}

void WindowEstimator::begin(const WindowScan& scan, const Eigen::Isometry3d& T_map_sensor,
                            const Eigen::Vector3d& velocity, const StartOmega& start, const Workers& workers) {
  const auto lay_trajectory = [&] {
    trajectory_.begin(scan.stamp_s + std::min(0.0, scan.begin_s), scan.stamp_s + std::max(0.0, scan.end_s),
                      T_map_sensor, velocity, start.omega);
  };
  lay_trajectory();
  take(scan);
  period_.add(scan.stamp_s);
  first_ = {scan.stamp_s, scan.begin_s, scan.end_s};
  stamp_errors_.setZero();
  this_stamp_ = {};
  interval_.reset();
  scan_error_ = {};
  map_error_.setZero();
  map_age_ = 0.0;
  shown_motions_ = {};
  bodies_.forget();
  scans_ = 1;
  const std::size_t coefficients = trajectory_.coefficients().size();
  if (quadratic_) {
    quadratic_->keep_field_only(coefficients);
  }
  average_doppler(scan, true, workers);
  const std::size_t faces = scan.whole->channels().face.empty() ? 1 : kMaxFaces;
  if (is_calibrated_ && scans_ever_ == 0) {
    check_calibration(faces);
  }
  if (!field_) {
    field_.emplace(cells_.cells(), faces);
    theta_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field_->size()));
    quadratic_.emplace(theta_.size(), coefficients, config_.learn_vibration);
  }
  linearise_here();
  if (!settle_first(scan, start.sigma_rad_s, workers)) {
    theta_.setZero();  // what was known of the sensor does not fit
    quadratic_.emplace(theta_.size(), coefficients, config_.learn_vibration);
    lay_trajectory();
    linearise_here();
    settle_first(scan, start.sigma_rad_s, workers);
  }
  join(start_terms(scan, start.sigma_rad_s), workers);
  find_twist();
  ++scans_ever_;
}

/// Fits the first scan; whether that worked.
bool WindowEstimator::settle_first(const WindowScan& scan, double omega_sigma_rad_s, const Workers& workers) {
  for (int pass = 0; pass < kStartPasses; ++pass) {
    if (pass < kFirstPasses) {
      average_doppler(scan, pass == 0, workers);
    }
    linearise();
    const Problem rest = start_terms(scan, omega_sigma_rad_s);
    factor_tail(rest);
    if (!(solve(rest) < kMaxCoordinate_m)) {
      return false;
    }
    learn_field();
    if (scans_ever_ == 0 && pass >= kFirstPasses) {
      learn_motion(stamp_s() + begin_s_, stamp_s() + end_s_);
    }
  }
  motion_prior_.keep();
  return true;
}

WindowMotion WindowEstimator::update(const WindowScan& scan, const Scan& first_points, mapping::PlaneMap& map,
                                     const std::optional<Eigen::Isometry3d>& start, const IsBelieved& is_believed,
                                     const Workers& workers) {
  const Learned before = learned();
  WindowMotion motion;
  motion.points = scan.static_points->size();
  const double last_s = stamp_s();
  const std::size_t first_new = trajectory_.coefficients().size() - 3;
  advance(scan);
  if (start) {
    const Vector6d twist = log_se3(trajectory_.pose(last_s).inverse() * *start) / (stamp_s() - last_s);
    trajectory_.set_constant_twist(last_s, twist.tail<3>(), twist.head<3>());
  }
  std::optional<PlaneTerms> planes;
  for (int round = 0; round < kNoiseRounds; ++round) {
    iterate(scan, first_points, first_new, map, planes, motion, workers);
    if (motion.diverged) {
      forget_scan(before);
      return motion;
    }
    learn_pointing(*planes);
    if (std::max(learn_stamps(), learn_scan_errors()) < kMuchNoise) {
      break;
    }
  }
  learn_period();
  stamp_variance_.keep();
  scan_error_variance_.keep();
  pointing_variance_.keep();
  workers.both(
      [&] {
        learn_motion(last_s, stamp_s());
        motion_prior_.keep();
      },
      [&] {
        compare_with_planes(*scan.static_points, false, {}, *planes);
        motion.planes = planes->quality();
      });
  motion.T_target_source = trajectory_.pose(stamp_s()).inverse() * trajectory_.pose(last_s);
  if (!is_believed(motion)) {
    forget_scan(before);
    return motion;
  }
  join(scan_terms(planes, first_new), workers);
  if (!elimination_.is_solvable() || !rest_factor_.is_solvable()) {
    motion.diverged = true;
    return motion;
  }
  shown_motions_ = planes->shown_motions();
  learn_roughness(motion.planes);
  motion_between(last_s, motion);
  find_twist();
  ++scans_;
  ++scans_ever_;
  take_in_sweep(motion.planes.share);
  walk_field(motion.T_target_source.translation().norm());
  quadratic_->drop_coefficients(trajectory_.drop_before(stamp_s() + std::min(0.0, begin_s_)));
  return motion;
}

WindowEstimator::Learned WindowEstimator::learned() const {
  return {motion_prior_, pointing_variance_, stamp_variance_, period_variance_, scan_error_variance_};
}

/// Of a scan that has not joined the past. What was learned from planes that do not fit is an error of no sensor.
void WindowEstimator::forget_scan(const Learned& before) {
  motion_prior_ = before.motion;
  pointing_variance_ = before.pointing;
  stamp_variance_ = before.stamps;
  period_variance_ = before.periods;
  scan_error_variance_ = before.scan_errors;
  theta_ = theta_0_;
}

void WindowEstimator::take(const WindowScan& scan) {
  stamp_s_ = scan.stamp_s;
  begin_s_ = scan.begin_s;
  end_s_ = scan.end_s;
}

/// The quadratic of the past is about the state at hand.
void WindowEstimator::linearise_here() {
  coefficients_0_ = trajectory_.coefficients();
  vibration_0_ = trajectory_.vibration();
  theta_0_ = theta_;
  map_error_0_ = map_error_;
  stamp_errors_0_ = stamp_errors_;
}

/// Makes room for a scan: coefficients, its stamp, and its stamp as the reference.
void WindowEstimator::advance(const WindowScan& scan) {
  last_middle_s_ = stamp_s() + 0.5 * (begin_s_ + end_s_);
  quadratic_->next_stamp();
  stamp_errors_ << stamp_errors_[1], 0.0;
  last_stamp_ = this_stamp_;
  quadratic_->append_coefficients(trajectory_.extend(scan.stamp_s + std::max(0.0, scan.end_s), kEven_s));
  const TrajectoryPoint to = trajectory_.at(scan.stamp_s);
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = to.R;
  B.bottomRightCorner<3, 3>() = to.R;
  B.bottomLeftCorner<3, 3>() = skew(to.p) * to.R;
  quadratic_->move_reference(trajectory_.move_reference(scan.stamp_s), B);
  map_error_.reshaped(6, Layout::kMapNodes) = B.partialPivLu().solve(map_error_.reshaped(6, Layout::kMapNodes)).eval();
  scan_error_ = {};
  interval_ = period_.add(scan.stamp_s);
  if (interval_) {
    interval_->value -= scan.stamp_s - stamp_s_;
  }
  take(scan);
  linearise_here();
}

/// Gauss-Newton steps until they are short. The first scan is laid anew with each step of the second.
void WindowEstimator::iterate(const WindowScan& scan, const Scan& first_points, std::size_t first_new,
                              mapping::PlaneMap& map, std::optional<PlaneTerms>& planes, WindowMotion& motion,
                              const Workers& workers) {
  const bool is_second = scans_ == 1;
  const int passes = scans_ever_ < kFirstScans ? kFirstPasses : kPasses;
  const int limit = is_second ? kSecondTimes * config_.max_iterations : config_.max_iterations;
  motion.converged = false;
  double step = std::numeric_limits<double>::infinity();
  for (int k = 0; k < limit && !motion.converged; ++k, ++motion.iterations) {
    if (is_second) {
      lay_first_again(first_points, map, workers);
    }
    if (is_second || !planes) {
      planes.emplace(*scan.static_points, map, stamp_s(), config_.knot_spacing_s / kSlices, workers);
    }
    if (motion.iterations == 0) {
      predict(scan, first_new, workers);
    }
    const std::vector<Matrix6d> displacements =
        motion.iterations < kMinIterations ? displacement_covariances(planes->slice_times()) : std::vector<Matrix6d>{};
    workers.both(
        [&] {
          if (motion.iterations == 0) {
            return;
          }
          if (motion.iterations < passes) {
            renew_doppler(scan, false, workers);
          }
          if (motion.iterations < passes || step > kStraight) {
            linearise();
          }
        },
        [&] { compare_with_planes(*scan.static_points, true, displacements, *planes); });
    step = solve(scan_terms(planes, first_new));
    if (!(step < kMaxCoordinate_m)) {
      motion.diverged = true;
      return;
    }
    motion.converged = step < kStep && motion.iterations + 1 >= kMinIterations;
  }
}

/// Without planes: how well the past and the Doppler know where the scan is.
void WindowEstimator::predict(const WindowScan& scan, std::size_t first_new, const Workers& workers) {
  renew_doppler(scan, true, workers);
  linearise();
  const Problem rest = scan_terms({}, first_new);
  factor_tail(rest);
  factor(rest);
}

void WindowEstimator::compare_with_planes(const Scan& points, bool adapt, const std::vector<Matrix6d>& displacements,
                                          PlaneTerms& planes) const {
  planes.set_stamp(stamp_s());
  planes.set_last_sweep(last_sweep());
  planes.set_past_motions(shown_motions_);
  planes.associate(trajectory_, map_error_,
                   {config_.min_sigma_m, model_sigma_m_, config_.repeated_patches, kPlaneKernel,
                    config_.max_noise_share, pointing_variance(points)},
                   adapt, displacements);
}

/// Weights of points around the trajectory of the moment.
void WindowEstimator::average_doppler(const WindowScan& scan, bool is_first_pass, const Workers& workers) {
  doppler_.reset();
  averaged_along_.reset();
  hidden_azimuths_.clear();
  if (scan.measured == nullptr) {
    return;
  }
  averaged_along_ = sampled_motion();
  static_doppler(*scan.whole, workers, predicted_);
  cells_.average(*scan.whole, *scan.is_moving, *scan.measured, predicted_, is_first_pass ? kFirstGate_mps : kGate_mps,
                 workers);
  hidden_azimuths_ = cells_.hidden_azimuths(*scan.whole);
  if (field_) {
    field_->columns(cells_.cells(), workers, columns_);
    weigh_doppler(scan, workers);
  }
}

/// The Doppler at the trajectory of the moment.
void WindowEstimator::renew_doppler(const WindowScan& scan, bool is_first_pass, const Workers& workers) {
  const bool is_new = scans_ever_ < kFirstScans;
  if (is_first_pass || is_new || !is_averaged_here()) {
    average_doppler(scan, is_new, workers);
  } else {
    weigh_doppler(scan, workers);
  }
}

/// Whether points of a cell, which are seen in nearly the same direction, would have the same weights as they have.
bool WindowEstimator::is_averaged_here() const {
  return averaged_along_ && sampled_motion().is_near(*averaged_along_, kSameVelocity_mps, kSameOmega_rad_s);
}

/// Weights of cells around the trajectory of the moment.
void WindowEstimator::weigh_doppler(const WindowScan& scan, const Workers& workers) {
  doppler_.emplace(cells_.cells(), columns_, doppler_state(), stamp_s(), cell_variance_, scan.whole->is_of_rig(),
                   workers);
}

/// The rotation of the first scan is known now: its points are moved to where they were.
void WindowEstimator::lay_first_again(const Scan& first_points, mapping::PlaneMap& map, const Workers& workers) {
  WindowScan first;
  first.stamp_s = first_.stamp_s;
  first.begin_s = first_.begin_s;
  first.end_s = first_.end_s;
  first.static_points = &first_points;
  map.clear();
  add_to_map(first, map, workers);
  map_error_.setZero();
}

}  // namespace dynamic_icp::window
