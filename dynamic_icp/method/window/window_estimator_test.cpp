// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/window_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/hall_drive.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using namespace hall;

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

TEST(WindowEstimator, FindsTheYawThatNothingHasShown) {
  // Without planes nothing shows how the sensor turns. Then they are back: floor and ceiling, nearly all that is seen,
  // fit at any yaw, and the few meters of wall only near the true one.
  constexpr int kBack = 17;
  Drive blind;
  blind.planes_until = 4;
  blind.planes_again = kBack;
  blind.is_there = [](const Vector3d& point) {
    return std::abs(point.z()) > 3.0 || (std::abs(point.y()) > 7.0 && std::abs(point.x() - 14.0) < 4.0);
  };
  const auto yaw_error = [&](int last) {
    const DriveRun run = drive(blind, last + 1);
    expect_finite(run);
    const Eigen::Isometry3d truth = path(0.0).inverse() * path(blind.begin_s(last));
    return std::abs(log_se3(run.estimator.trajectory().pose(run.estimator.stamp_s()).inverse() * truth)[2]);
  };
  EXPECT_GT(yaw_error(kBack - 1), 0.03);
  EXPECT_LT(yaw_error(kBack), 0.003);
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

TEST(WindowEstimator, TheGroundTellsNothingOfTheWayAlongIt) {
  // The map goes along with any motion, so what of the Doppler looks like one stays as unknown as it was.
  Drive on_ground;
  on_ground.error_mps = [](double azimuth) { return azimuth > 0.0 ? 0.2 : 0.0; };
  on_ground.is_there = [](const Vector3d& point) { return point.z() < -3.0; };
  const DriveRun run = drive(on_ground, 40);
  expect_finite(run);
  const std::optional<SensorCalibration> calibration = run.estimator.calibration();
  ASSERT_TRUE(calibration);
  const auto velocity = std::ranges::find(calibration->parts, "velocity", &SensorCalibration::Part::name);
  ASSERT_NE(velocity, calibration->parts.end());
  EXPECT_GT(velocity->sigma_mps[0], 0.8 * velocity->scale_mps);
  EXPECT_GT(velocity->sigma_mps[1], 0.8 * velocity->scale_mps);
  EXPECT_LT(velocity->sigma_mps[2], 0.2 * velocity->scale_mps) << "the ground shows what is across it";
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
