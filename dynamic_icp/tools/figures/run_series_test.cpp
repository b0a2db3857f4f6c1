// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_series.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace dynamic_icp::figures {
namespace {

runs::RunFiles run_of(const std::vector<runs::FrameRow>& frames) {
  runs::RunFiles run;
  run.frames = frames;
  run.objects.resize(frames.size());
  return run;
}

runs::FrameRow frame_row(const char* status, const char* reason, double iterations) {
  runs::FrameRow frame;
  frame.status = status;
  frame.reason = reason;
  frame.iterations = iterations;
  frame.points_used = 100.0;
  return frame;
}

/// The values of the first line of the series called `id`.
std::vector<double> values_of(const runs::RunFiles& run, const char* id) {
  for (const RunSeries& series : run_series(run, std::nullopt)) {
    if (series.id == id) {
      return series.panel.series.front().values;
    }
  }
  return {};
}

TEST(RunSeries, SpeedIsThatAtTheStampWhereTheRunTellsIt) {
  runs::FrameRow swept = frame_row("ok", "converged", 5.0);
  swept.ego_velocity = {3.0, 0.0, 0.0};  // of the whole sweep
  swept.twist = runs::TwistRow{.angular = Eigen::Vector3d::Zero(), .linear = {3.0, 4.0, 0.0}};
  runs::FrameRow instant = swept;
  instant.twist.reset();
  EXPECT_EQ(values_of(run_of({swept, instant}), "ego_speed"), (std::vector<double>{5.0, 3.0}));
}

TEST(RunSeries, NothingRegisteredIsAGapAndNoPerfectMatch) {
  const std::vector<double> iterations =
      values_of(run_of({frame_row("ok", "first", 0.0), frame_row("ok", "converged", 5.0),
                        frame_row("lost", "too_few_points", 0.0), frame_row("lost", "iteration_limit", 50.0)}),
                "iterations");
  ASSERT_EQ(iterations.size(), 4u);
  EXPECT_TRUE(std::isnan(iterations[0]));
  EXPECT_EQ(iterations[1], 5.0);
  EXPECT_TRUE(std::isnan(iterations[2]));
  EXPECT_EQ(iterations[3], 50.0);
}

TEST(RunSeries, ErrorsAreInMillimetres) {
  runs::FrameRow frame = frame_row("ok", "converged", 5.0);
  frame.inlier_rmse = 0.0348;
  const runs::RunFiles run = run_of({frame});
  EXPECT_NEAR(values_of(run, "inlier_rmse").front(), 34.8, 1e-9);
  const RunTruth truth{.poses = {std::nullopt},
                       .speed = {1.0},
                       .translation_error = {0.0005},
                       .rotation_error = {0.01},
                       .nees_rotation = {2.0},
                       .nees_translation = {4.0}};
  for (const RunSeries& series : run_series(run, truth)) {
    if (series.id == "translation_error") {
      EXPECT_EQ(series.unit, "mm");
      EXPECT_NEAR(series.panel.series.front().values.front(), 0.5, 1e-12);
    }
  }
}

const RunSeries* series_called(const std::vector<RunSeries>& all, const char* id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const RunSeries& series) { return series.id == id; });
  return found == all.end() ? nullptr : &*found;
}

/// Frames 0.1 s apart along x, by steps in m.
runs::RunFiles run_along_x(const std::vector<double>& steps_m) {
  runs::RunFiles run = run_of(std::vector<runs::FrameRow>(steps_m.size() + 1, frame_row("ok", "converged", 5.0)));
  double x = 0.0;
  for (std::size_t k = 0; k <= steps_m.size(); ++k) {
    formats::StampedPose pose;
    pose.stamp = Stamp{100'000'000 * static_cast<std::int64_t>(k)};
    pose.T_world_sensor = Eigen::Translation3d(x, 0.0, 0.0) * Eigen::Isometry3d::Identity();
    run.trajectory.push_back(pose);
    x += k < steps_m.size() ? steps_m[k] : 0.0;
  }
  return run;
}

TEST(RunSeries, InnovationIsTheMotionBeyondTheTwistBeforeItOverWhatBothState) {
  runs::RunFiles run = run_along_x({1.0, 1.03, 1.0});
  for (runs::FrameRow& frame : run.frames) {
    frame.twist = runs::TwistRow{.angular = Eigen::Vector3d::Zero(), .linear = {10.0, 0.0, 0.0}};
    frame.twist->covariance = 0.04 * Matrix6d::Identity();
    frame.pose_covariance = 5e-4 * Matrix6d::Identity();
  }
  run.frames[3].status = "lost";
  const std::vector<RunSeries> all = run_series(run, std::nullopt);
  const RunSeries* innovation = series_called(all, "innovation");
  ASSERT_NE(innovation, nullptr);
  const std::vector<double>& translation = innovation->panel.series[0].values;
  EXPECT_TRUE(std::isnan(translation[0]));
  EXPECT_NEAR(translation[1], 0.0, 1e-9);
  EXPECT_NEAR(translation[2], 0.03 * 0.03 / (0.1 * 0.1 * 0.04 + 5e-4), 1e-9);
  EXPECT_TRUE(std::isnan(translation[3])) << "nothing is known of a lost scan";
  EXPECT_NEAR(innovation->panel.series[1].values[2], 0.0, 1e-9) << "no rotation";
  ASSERT_EQ(innovation->panel.levels.size(), 1u);
  EXPECT_EQ(innovation->panel.levels[0].value, 3.0);
}

TEST(RunSeries, RunsThatStateNoCovarianceHaveNoInnovation) {
  const std::vector<RunSeries> all = run_series(run_along_x({1.0, 1.0}), std::nullopt);
  EXPECT_EQ(series_called(all, "innovation"), nullptr);
}

TEST(RunSeries, PositionErrorIsTheDistanceToTheTruePosition) {
  const runs::RunFiles run = run_along_x({1.0, 1.0});
  RunTruth truth{.poses = {Eigen::Isometry3d::Identity(), std::nullopt, Eigen::Isometry3d::Identity()},
                 .speed = {10.0, 10.0, 10.0},
                 .translation_error = {0.0, 0.0, 0.0},
                 .rotation_error = {0.0, 0.0, 0.0},
                 .nees_rotation = {1.0, 1.0, 1.0},
                 .nees_translation = {1.0, 1.0, 1.0}};
  truth.poses[2]->translation() = Eigen::Vector3d(2.0, 0.3, 0.4);
  const std::vector<RunSeries> all = run_series(run, truth);
  const RunSeries* error = series_called(all, "position_error");
  ASSERT_NE(error, nullptr);
  const std::vector<double>& values = error->panel.series[0].values;
  EXPECT_EQ(values[0], 0.0);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_NEAR(values[2], 0.5, 1e-12);
}

}  // namespace
}  // namespace dynamic_icp::figures
