// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/swept_room.hpp"

// For tests of the window estimator: a drive whose trajectory is known in continuous time.
namespace dynamic_icp::window::hall {

inline constexpr double kPeriod_s = 0.1;  ///< from scan to scan, as long as one takes

/// Along a hall at 10 m/s, swaying and turning.
inline Eigen::Isometry3d path(double t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.01 * std::sin(3.0 * t), 0.015 * std::sin(2.0 * t), 0.15 * std::sin(1.5 * t)});
  T.translation() << -12.0 + 10.0 * t + 0.5 * t * t, 0.8 * std::sin(t), 0.05 * std::sin(4.0 * t);
  return T;
}

/// [omega; velocity] in sensor axes.
inline Vector6d twist(double t) {
  constexpr double kStep = 1e-4;
  return log_se3(path(t - kStep).inverse() * path(t + kStep)) / (2.0 * kStep);
}

/// A sensor that turns once around itself in each scan.
struct Drive {
  double doppler_noise_mps = 0.03;
  std::function<double(double)> error_mps = [](double) { return 0.0; };      ///< of the Doppler, by azimuth
  std::function<double(int)> begin_s = [](int k) { return kPeriod_s * k; };  ///< when a scan begins
  std::function<double(int)> late_s = [](int) { return 0.0; };               ///< how late a stamp says the scan is
  std::size_t points = 9000;
  bool has_doppler = true;
  int planes_until = std::numeric_limits<int>::max();  ///< scans with planes
  int planes_again = std::numeric_limits<int>::max();  ///< and from this one on
  std::function<bool(const Eigen::Vector3d&)> is_there = [](const Eigen::Vector3d&) { return true; };  ///< in the hall
  std::vector<Eigen::Vector3d> lever_arms = {};  ///< m, of the sensors of a rig; none: one at the origin

  [[nodiscard]] Scan scan(int k) const {
    Room room;
    room.half << 40.1, 7.1, 3.1;
    std::mt19937 random(static_cast<unsigned>(100 + k));
    std::normal_distribution<double> normal;
    const double stamp_s = begin_s(k);
    RawScan raw;
    for (const Eigen::Vector3d& point : room.points(static_cast<unsigned>(1 + k), points)) {
      if (!is_there(point)) {
        continue;
      }
      const Eigen::Vector3d at_stamp = path(stamp_s).inverse() * point;
      const double tau =
          kPeriod_s * (std::atan2(at_stamp.y(), at_stamp.x()) + std::numbers::pi) / (2.0 * std::numbers::pi);
      const Eigen::Vector3d seen = path(stamp_s + tau).inverse() * point;
      const Eigen::Vector3d arm =
          lever_arms.empty() ? Eigen::Vector3d::Zero() : lever_arms[raw.points.size() % lever_arms.size()];
      const Eigen::Vector3d u = (seen - arm).normalized();
      const Vector6d moves = twist(stamp_s + tau);
      const Eigen::Vector3d velocity = Eigen::Vector3d(moves.tail<3>()) + Eigen::Vector3d(moves.head<3>()).cross(arm);
      if (!lever_arms.empty()) {
        raw.channels.sensor.push_back(static_cast<std::uint8_t>(raw.points.size() % lever_arms.size()));
      }
      raw.points.push_back(seen);
      raw.times.push_back(tau);
      raw.doppler.push_back(-u.dot(velocity) + error_mps(std::atan2(u.y(), u.x())) +
                            doppler_noise_mps * normal(random));
    }
    raw.times.front() = 0.0;
    raw.times.back() = kPeriod_s;
    for (const Eigen::Vector3d& arm : lever_arms) {
      raw.mountings.push_back(Eigen::Isometry3d(Eigen::Translation3d(arm)));
    }
    return Scan::from_raw(raw);
  }
};

/// What the estimator says at a scan, and how that errs.
struct Step {
  WindowMotion motion;
  Vector6d error = Vector6d::Zero();  ///< left perturbation, as the covariance has it
  double stamp_error_s = 0.0;
  Vector6d twist_error = Vector6d::Zero();
};

/// An estimator after some scans of a drive.
struct DriveRun {
  WindowEstimator estimator;
  Scan last_scan;
  std::vector<Step> steps;

  [[nodiscard]] double worst_move(std::size_t first) const {
    double worst = 0.0;
    for (std::size_t k = first; k < steps.size(); ++k) {
      worst = std::max(worst, steps[k].error.tail<3>().norm());
    }
    return worst;
  }
  [[nodiscard]] double worst_turn(std::size_t first) const {
    double worst = 0.0;
    for (std::size_t k = first; k < steps.size(); ++k) {
      worst = std::max(worst, steps[k].error.head<3>().norm());
    }
    return worst;
  }
};

inline Step step_of(const Drive& drive, const WindowMotion& motion, const WindowEstimator& estimator, int k) {
  Step step;
  step.motion = motion;
  step.error = log_se3(motion.T_target_source * path(drive.begin_s(k - 1)).inverse() * path(drive.begin_s(k)));
  step.stamp_error_s = estimator.stamp_s() - drive.begin_s(k);
  const TrajectoryPoint at = estimator.trajectory().at(estimator.stamp_s());
  step.twist_error << at.omega, at.velocity;
  step.twist_error -= twist(drive.begin_s(k));
  return step;
}

/// The first `scans` of a drive.
inline DriveRun drive(const Drive& drive, int scans, const WindowConfig& config = {}, int threads = 1,
                      const std::optional<SensorCalibration>& calibration = {}) {
  const Workers workers(threads);
  DriveRun run{WindowEstimator(config), {}, {}};
  if (calibration) {
    run.estimator.set_calibration(*calibration);
  }
  mapping::PlaneMap map({});
  const Scan nothing;
  Scan first_points;
  for (int k = 0; k < scans; ++k) {
    run.last_scan = drive.scan(k);
    const Scan& scan = run.last_scan;
    run.estimator.sort(scan, workers);
    const std::vector<double> measured = scan.doppler();
    const std::vector<std::uint8_t> is_moving(scan.size(), 0);
    WindowScan now;
    now.stamp_s = drive.begin_s(k) + drive.late_s(k);
    now.end_s = kPeriod_s;
    now.whole = &scan;
    now.measured = drive.has_doppler ? &measured : nullptr;
    now.is_moving = &is_moving;
    now.static_points = k < drive.planes_until || k >= drive.planes_again ? &scan : &nothing;
    if (k == 0) {
      first_points = *now.static_points;
      run.estimator.begin(now, Eigen::Isometry3d::Identity(), twist(0.0).tail<3>(),
                          {Eigen::Vector3d::Zero(), WindowConfig{}.start_omega_rad_s}, workers);
    } else {
      run.steps.push_back(
          step_of(drive,
                  run.estimator.update(
                      now, first_points, map, std::nullopt, [](const WindowMotion&) { return true; }, workers),
                  run.estimator, k));
    }
    now.stamp_s = run.estimator.stamp_s();
    run.estimator.add_to_map(now, map, workers);
  }
  return run;
}

inline void expect_finite(const DriveRun& run) {
  for (const Step& step : run.steps) {
    EXPECT_FALSE(step.motion.diverged);
    EXPECT_TRUE(step.motion.T_target_source.matrix().allFinite());
    EXPECT_TRUE(step.motion.covariance.allFinite());
    EXPECT_EQ(step.motion.covariance, Matrix6d(step.motion.covariance.transpose()));
    EXPECT_GT(dense::symmetric_parts(step.motion.covariance).values.minCoeff(), 0.0);
    EXPECT_TRUE(std::isfinite(step.motion.planes.rms_m));
    EXPECT_TRUE(std::isfinite(step.stamp_error_s));
  }
  EXPECT_TRUE(run.estimator.theta().allFinite());
}

}  // namespace dynamic_icp::window::hall
