// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_series.hpp"

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
  const RunTruth truth{
      .poses = {std::nullopt}, .speed = {1.0}, .translation_error = {0.0005}, .rotation_error = {0.01}};
  for (const RunSeries& series : run_series(run, truth)) {
    if (series.id == "translation_error") {
      EXPECT_EQ(series.unit, "mm");
      EXPECT_NEAR(series.panel.series.front().values.front(), 0.5, 1e-12);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::figures
