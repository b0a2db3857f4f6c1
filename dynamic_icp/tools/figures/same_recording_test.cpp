// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/same_recording.hpp"

#include <functional>
#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::figures {
namespace {

/// Ten scans a second, those of `first` to `first + 39`, of the drive in which scan k has points(k) points.
runs::RunFiles run_over(const char* path, std::size_t first, const std::function<double(std::size_t)>& points) {
  runs::RunFiles run;
  run.run = {{"input.path", std::string(path)}};
  for (std::size_t k = first; k < first + 40; ++k) {
    runs::FrameRow frame;
    frame.index = k;
    frame.points = points(k);
    run.frames.push_back(frame);
    formats::StampedPose pose;
    pose.stamp = Stamp{100'000'000'000 + 100'000'000 * static_cast<std::int64_t>(k)};
    pose.T_world_sensor = Eigen::Translation3d(static_cast<double>(k), 0.0, 0.0) * Eigen::Isometry3d::Identity();
    run.trajectory.push_back(pose);
  }
  return run;
}

double of_one_drive(std::size_t k) { return static_cast<double>(9000 + 37 * k % 101); }
double of_another(std::size_t k) { return static_cast<double>(9000 + 41 * k % 103); }

TEST(SameRecording, TwoContainersOfOneDriveAreOne) {
  const runs::RunFiles npz = run_over("drive", 0, of_one_drive);
  EXPECT_TRUE(is_same_recording(npz, run_over("drive.mcap", 0, of_one_drive)));
  EXPECT_TRUE(is_same_recording(npz, run_over("drive.mcap", 7, of_one_drive))) << "from a later scan on";
  EXPECT_FALSE(is_same_recording(npz, run_over("other", 0, of_another)));
  EXPECT_TRUE(is_same_recording(npz, run_over("drive", 0, of_another))) << "one path";
}

TEST(SameRecording, EqualNumbersOfPointsInAllScansTellNothing) {
  const auto always = [](std::size_t) { return 65536.0; };
  EXPECT_FALSE(is_same_recording(run_over("a", 0, always), run_over("b", 0, always)));
}

TEST(SameRecording, OtherTimesAreAnotherDrive) {
  const runs::RunFiles even = run_over("a", 0, of_one_drive);
  runs::RunFiles uneven = run_over("b", 0, of_one_drive);
  for (std::size_t k = 0; k < uneven.trajectory.size(); ++k) {
    uneven.trajectory[k].stamp.ns += static_cast<std::int64_t>(5'000'000 * (k % 2));
  }
  EXPECT_FALSE(is_same_recording(even, uneven));
}

TEST(SameRecording, TheDifferenceIsTheLargestOverTheCommonScans) {
  const runs::RunFiles a = run_over("a", 0, of_one_drive);
  runs::RunFiles b = run_over("b", 10, of_one_drive);
  b.trajectory[4].T_world_sensor.translation().y() = 0.003;
  b.trajectory[8].T_world_sensor.linear() = exp_so3({0.0, 0.0, 0.5 * std::numbers::pi / 180.0});
  const auto apart = difference(a, b);
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->scans, 30u);
  EXPECT_NEAR(apart->translation_m, 0.003, 1e-12);
  EXPECT_NEAR(apart->rotation_deg, 0.5, 1e-9);
  EXPECT_FALSE(difference(a, run_over("c", 100, of_one_drive)));
}

}  // namespace
}  // namespace dynamic_icp::figures
