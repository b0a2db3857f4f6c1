// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_estimator.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/swept_room.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kPeriod_s = 0.1;

/// Along a hall at 10 m/s, swaying and turning.
Eigen::Isometry3d path(double t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.01 * std::sin(3.0 * t), 0.015 * std::sin(2.0 * t), 0.15 * std::sin(1.5 * t)});
  T.translation() << -12.0 + 10.0 * t + 0.5 * t * t, 0.8 * std::sin(t), 0.05 * std::sin(4.0 * t);
  return T;
}

/// [omega; velocity] in sensor axes.
Vector6d twist(double t) {
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
  std::vector<Vector3d> lever_arms = {};               ///< m, of the sensors of a rig; none: one at the origin

  [[nodiscard]] Scan scan(int k) const {
    Room room;
    room.half << 40.1, 7.1, 3.1;
    std::mt19937 random(static_cast<unsigned>(100 + k));
    std::normal_distribution<double> normal;
    const double stamp_s = begin_s(k);
    RawScan raw;
    for (const Vector3d& point : room.points(static_cast<unsigned>(1 + k), points)) {
      const Vector3d at_stamp = path(stamp_s).inverse() * point;
      const double tau = kPeriod_s * (std::atan2(at_stamp.y(), at_stamp.x()) + pi) / (2.0 * pi);
      const Vector3d seen = path(stamp_s + tau).inverse() * point;
      const Vector3d arm = lever_arms.empty() ? Vector3d::Zero() : lever_arms[raw.points.size() % lever_arms.size()];
      const Vector3d u = (seen - arm).normalized();
      const Vector6d moves = twist(stamp_s + tau);
      const Vector3d velocity = Vector3d(moves.tail<3>()) + Vector3d(moves.head<3>()).cross(arm);
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
    for (const Vector3d& arm : lever_arms) {
      raw.mountings.push_back(Eigen::Isometry3d(Eigen::Translation3d(arm)));
    }
    return Scan::from_raw(raw);
  }
};

struct Step {
  WindowMotion motion;
  Vector6d error = Vector6d::Zero();  ///< left perturbation, as the covariance has it
  double stamp_error_s = 0.0;
  Vector6d twist_error = Vector6d::Zero();
};

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

Step step_of(const Drive& drive, const WindowMotion& motion, const WindowEstimator& estimator, int k) {
  Step step;
  step.motion = motion;
  step.error = log_se3(motion.T_target_source * path(drive.begin_s(k - 1)).inverse() * path(drive.begin_s(k)));
  step.stamp_error_s = estimator.stamp_s() - drive.begin_s(k);
  const TrajectoryPoint at = estimator.trajectory().at(estimator.stamp_s());
  step.twist_error << at.omega, at.velocity;
  step.twist_error -= twist(drive.begin_s(k));
  return step;
}

DriveRun drive(const Drive& drive, int scans, const WindowConfig& config = {}, int threads = 1,
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
    now.static_points = k < drive.planes_until ? &scan : &nothing;
    if (k == 0) {
      first_points = *now.static_points;
      run.estimator.begin(now, Eigen::Isometry3d::Identity(), twist(0.0).tail<3>(),
                          {Vector3d::Zero(), WindowConfig{}.start_omega_rad_s}, workers);
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

void expect_finite(const DriveRun& run) {
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

TEST(WindowEstimator, FollowsADrive) {
  const DriveRun run = drive({}, 10);
  expect_finite(run);
  EXPECT_LT(run.worst_move(0), 0.002);
  EXPECT_LT(run.worst_turn(0), 5e-4);
  EXPECT_LT(run.worst_move(2), 0.001);
  EXPECT_LT(run.worst_turn(2), 3e-4);
  double chi_squares = 0.0;
  for (std::size_t k = 2; k < run.steps.size(); ++k) {
    const Step& step = run.steps[k];
    EXPECT_TRUE(step.motion.converged);
    EXPECT_LT(step.twist_error.tail<3>().norm(), 0.02);
    EXPECT_LT(step.twist_error.head<3>().norm(), 0.01);
    EXPECT_LT(std::abs(step.stamp_error_s), 5e-5);
    chi_squares += dense::normalised_squared(step.error, step.motion.covariance) / 6.0;
  }
  EXPECT_LT(chi_squares / static_cast<double>(run.steps.size() - 2), 2.0) << "errors are not far beyond what is stated";
  ASSERT_TRUE(run.estimator.point_noise());
  EXPECT_NEAR(*run.estimator.point_noise(), 0.03, 0.01);
}

TEST(WindowEstimator, LearnsAnErrorOfTheDoppler) {
  // A step in azimuth, as where one of several receivers is off. Much of it looks like a motion to the left.
  constexpr double kError_mps = 0.15;
  Drive stepped;
  stepped.error_mps = [](double azimuth) { return azimuth > 0.0 ? kError_mps : 0.0; };
  const DriveRun run = drive(stepped, 14);
  expect_finite(run);
  EXPECT_LT(run.worst_move(4), 0.0015);
  EXPECT_LT(run.worst_turn(4), 3e-4);
  FieldErrors field;
  run.estimator.field_errors(run.last_scan, Workers(1), field);
  const std::vector<double>& errors = field.learned;
  double left = 0.0, right = 0.0, lefts = 0.0, rights = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Vector3d& u = run.last_scan.directions()[i];
    (u.y() > 0.0 ? left : right) += errors[i];
    (u.y() > 0.0 ? lefts : rights) += 1.0;
  }
  EXPECT_NEAR(left / lefts, kError_mps, 0.01);
  EXPECT_NEAR(right / rights, 0.0, 0.01);
  EXPECT_LT(run.steps.back().twist_error.tail<3>().norm(), 0.02);
  // Left to itself the Doppler says otherwise.
  WindowConfig without;
  without.learn_field = false;
  EXPECT_GT(drive(stepped, 6, without).steps.back().twist_error.tail<3>().norm(), 0.05);
}

TEST(WindowEstimator, TellsWhatNoSensorErrsBy) {
  // Half of the view sets off. The motion of the sensor is known by the planes, so an error of the left explains much.
  Drive departing;
  departing.error_mps = [](double azimuth) { return azimuth > 0.0 ? 0.9 : 0.0; };
  const DriveRun run = drive(departing, 8);
  FieldErrors errors;
  run.estimator.field_errors(run.last_scan, Workers(1), errors);
  double learned = 0.0, credible = 0.0, lefts = 0.0;
  for (std::size_t i = 0; i < run.last_scan.size(); ++i) {
    if (run.last_scan.directions()[i].y() > 0.0) {
      learned += errors.learned[i];
      credible += errors.credible[i];
      lefts += 1.0;
    }
  }
  EXPECT_GT(learned / lefts, 0.5);
  EXPECT_GT(credible / lefts, 0.2);
  EXPECT_LT(credible / lefts, 0.4);
}

TEST(WindowEstimator, FindsAStampThatIsOff) {
  // A millisecond at 10 m/s is a centimetre.
  constexpr int kLate = 6;
  Drive late;
  late.late_s = [](int k) { return k == kLate ? 1e-3 : 0.0; };
  const DriveRun run = drive(late, 9);
  expect_finite(run);
  EXPECT_NEAR(run.steps[kLate - 1].stamp_error_s, 0.0, 1.5e-4) << "what is left of a millisecond";
  EXPECT_LT(run.worst_move(2), 0.0015);
}

TEST(WindowEstimator, LearnsWhetherStampsOrScansAreRegular) {
  // Stamps are even or not, and either they are right or the scans come evenly. Planes tell which; once they are absent
  // nothing else tells when a scan was taken. A millisecond is a centimetre.
  constexpr int kBlind = 24;
  const RandomSource random(3);
  const auto jitter_s = [&](int k) { return k == 0 ? 0.0 : 1e-3 * random.normal(static_cast<std::uint64_t>(k)); };
  Drive late;
  late.late_s = jitter_s;
  Drive irregular;
  irregular.begin_s = [&](int k) { return kPeriod_s * k + jitter_s(k); };
  for (Drive* const kind : {&late, &irregular}) {
    kind->planes_until = kBlind;
    const DriveRun run = drive(*kind, kBlind + 8);
    expect_finite(run);
    for (std::size_t k = kBlind; k < run.steps.size(); ++k) {
      EXPECT_NEAR(run.steps[k].stamp_error_s, run.steps[k - 1].stamp_error_s, 4e-4) << k;
    }
  }
}

TEST(WindowEstimator, DrivesByTheDopplerWherePlanesAreAbsent) {
  Drive blind;
  blind.planes_until = 0;
  const DriveRun run = drive(blind, 6);
  expect_finite(run);
  EXPECT_LT(run.steps.back().twist_error.tail<3>().norm(), 0.05);
  EXPECT_EQ(run.steps.back().motion.planes.on_planes, 0U);
  WindowConfig config;
  config.use_planes = false;
  expect_finite(drive({}, 4, config));
}

TEST(WindowEstimator, ARigSeesItsTurnInTheDoppler) {
  Drive rig;
  rig.lever_arms = {{2.0, 0.9, 0.3}, {2.0, -0.9, 0.3}, {-2.0, 0.9, 0.3}, {-2.0, -0.9, 0.3}};
  const DriveRun with_planes = drive(rig, 6);
  expect_finite(with_planes);
  EXPECT_LT(with_planes.worst_move(2), 0.0015);
  EXPECT_LT(with_planes.worst_turn(2), 4e-4);
  rig.planes_until = 0;
  const DriveRun blind = drive(rig, 8);
  expect_finite(blind);
  EXPECT_LT(blind.worst_turn(3), 3e-3);
  EXPECT_LT(blind.worst_move(3), 5e-3);
}

TEST(WindowEstimator, DrivesByPlanesWithoutDoppler) {
  Drive deaf;
  deaf.has_doppler = false;
  const DriveRun run = drive(deaf, 8);
  expect_finite(run);
  EXPECT_LT(run.worst_move(2), 0.003);
  EXPECT_LT(run.worst_turn(2), 4e-4);
  EXPECT_FALSE(run.estimator.point_noise());
  FieldErrors field;
  run.estimator.field_errors(run.last_scan, Workers(1), field);
  const std::vector<double>& errors = field.learned;
  EXPECT_EQ(errors, std::vector<double>(run.last_scan.size(), 0.0)) << "nothing was learned";
}

TEST(WindowEstimator, PredictsTheDopplerOfWhatStands) {
  Drive exact;
  exact.doppler_noise_mps = 0.0;
  WindowConfig smooth;  // this drive does not vibrate, and a sway at the rate of the sweep looks like a constant error
  smooth.learn_vibration = false;
  const DriveRun run = drive(exact, 6, smooth);
  std::vector<double> predicted;
  run.estimator.static_doppler(run.last_scan, Workers(1), predicted);
  ASSERT_EQ(predicted.size(), run.last_scan.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    squares += std::pow(predicted[i] - run.last_scan.doppler()[i], 2) / static_cast<double>(predicted.size());
  }
  // A constant error of the Doppler looks like a sway with the period of the sweep: some cm/s may be either.
  EXPECT_LT(std::sqrt(squares), 0.04);
}

TEST(WindowEstimator, BeginsAnewWithWhatItLearned) {
  Drive stepped;
  stepped.error_mps = [](double azimuth) { return azimuth > 0.0 ? 0.15 : 0.0; };
  DriveRun run = drive(stepped, 10);
  const Eigen::VectorXd before = run.estimator.theta();
  const Scan scan = stepped.scan(10);
  const std::vector<double> measured = scan.doppler();
  const std::vector<std::uint8_t> is_moving(scan.size(), 0);
  WindowScan now{10.0 * kPeriod_s, 0.0, kPeriod_s, &scan, &measured, &is_moving, &scan};
  run.estimator.sort(scan, Workers(1));
  run.estimator.begin(now, path(1.0), twist(1.0).tail<3>(), {twist(1.0).head<3>(), 0.01}, Workers(1));
  EXPECT_EQ(run.estimator.scans(), 1);
  EXPECT_LT((run.estimator.theta() - before).norm(), 0.1 * before.norm());
  EXPECT_LT((run.estimator.trajectory().pose(1.0).translation() - path(1.0).translation()).norm(), 1e-4);
  EXPECT_LT((run.estimator.trajectory().at(1.0).velocity - twist(1.0).tail<3>()).norm(), 0.05);
}

TEST(WindowEstimator, ACalibrationTellsErrorsFromMotion) {
  // Without planes nothing tells the velocity-like part of an error from a motion, unless it is known from elsewhere.
  Drive drifting;
  drifting.error_mps = [](double azimuth) { return 0.15 * std::sin(azimuth); };
  const std::optional<SensorCalibration> learned = drive(drifting, 14).estimator.calibration();
  ASSERT_TRUE(learned);
  drifting.planes_until = 0;
  const DriveRun unknown = drive(drifting, 5);
  const DriveRun known = drive(drifting, 5, {}, 1, learned);
  expect_finite(known);
  EXPECT_GT(unknown.steps.back().twist_error.tail<3>().norm(), 2.0 * known.steps.back().twist_error.tail<3>().norm());
  EXPECT_LT(known.steps.back().twist_error.tail<3>().norm(), 0.02);
}

TEST(WindowEstimator, WhatIsLearnedIsLearnedOnce) {
  // Handed on without a new scan but the first, a calibration says the same and not more.
  Drive exact;
  const std::optional<SensorCalibration> learned = drive(exact, 6).estimator.calibration();
  ASSERT_TRUE(learned);
  EXPECT_FALSE(WindowEstimator(WindowConfig{}).calibration()) << "before the first scan";
  const std::optional<SensorCalibration> again = drive(exact, 1, {}, 1, learned).estimator.calibration();
  ASSERT_TRUE(again);
  for (std::size_t k = 0; k < learned->information.size(); ++k) {
    const double before = learned->information[k][k];
    const double after = again->information[k][k];
    EXPECT_GE(after, 0.99 * before) << k;
    EXPECT_LT(after, 1.6 * before + 2e5) << k << ": one scan more";
  }
}

TEST(WindowEstimator, RefusesTheCalibrationOfAnotherSensor) {
  SensorCalibration learned = *drive({}, 3).estimator.calibration();
  SensorCalibration narrow = learned;
  narrow.shape.views[0].azimuth_span = 1.0;
  EXPECT_THROW(drive({}, 1, {}, 1, narrow), UsageError);
  SensorCalibration rig = learned;
  rig.shape.views.push_back(rig.shape.views[0]);
  EXPECT_THROW(drive({}, 1, {}, 1, rig), UsageError) << "its parts are those of one sensor";
  SensorCalibration torn = learned;
  torn.information.pop_back();
  EXPECT_THROW(drive({}, 1, {}, 1, torn), UsageError);
  SensorCalibration impossible = learned;
  impossible.information[2][2] = -1e9;
  EXPECT_THROW(drive({}, 1, {}, 1, impossible), UsageError);
  impossible.information[2][2] = std::nan("");
  EXPECT_THROW(drive({}, 1, {}, 1, impossible), UsageError);
  SensorCalibration huge = learned;
  huge.shape.line_elevations_rad.resize(1000000);
  EXPECT_THROW(drive({}, 1, {}, 1, huge), UsageError);
  WindowConfig without;
  without.learn_field = false;
  EXPECT_THROW(drive({}, 1, without, 1, learned), UsageError);
}

TEST(WindowEstimator, DoesNotDependOnTheThreads) {
  const DriveRun one = drive({}, 4, {}, 1);
  const DriveRun three = drive({}, 4, {}, 3);
  for (std::size_t k = 0; k < one.steps.size(); ++k) {
    EXPECT_EQ(one.steps[k].motion.T_target_source.matrix(), three.steps[k].motion.T_target_source.matrix());
    EXPECT_EQ(one.steps[k].motion.covariance, three.steps[k].motion.covariance);
  }
  EXPECT_EQ(one.estimator.theta(), three.estimator.theta());
}

}  // namespace
}  // namespace dynamic_icp::window
