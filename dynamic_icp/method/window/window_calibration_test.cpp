// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// What was learned of the sensor outlives its trajectory, and serves another drive.
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

#include "testing/hall_drive.hpp"

namespace dynamic_icp::window {
namespace {

using namespace hall;

TEST(WindowCalibration, BeginsAnewWithWhatItLearned) {
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

TEST(WindowCalibration, ACalibrationTellsErrorsFromMotion) {
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

TEST(WindowCalibration, WhatIsLearnedIsLearnedOnce) {
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

TEST(WindowCalibration, RefusesTheCalibrationOfAnotherSensor) {
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

}  // namespace
}  // namespace dynamic_icp::window
