// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/pose_interpolation.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::formats {
namespace {

/// Along x: at 0 m at 1 s, 2 m at 1.2 s, 3 m at 2 s.
Trajectory uneven() {
  Trajectory trajectory;
  for (const auto& [ns, x] : {std::pair(1'000'000'000, 0.0), {1'200'000'000, 2.0}, {2'000'000'000, 3.0}}) {
    trajectory.push_back({Stamp{ns}, Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0))});
  }
  return trajectory;
}

std::optional<double> place_at(std::int64_t ns, double max_gap_s) {
  const auto pose = pose_at(uneven(), Stamp{ns}, max_gap_s);
  return pose ? std::optional(pose->translation().x()) : std::nullopt;
}

TEST(PoseInterpolation, BetweenPosesThatAreNearEachOther) {
  EXPECT_NEAR(*place_at(1'050'000'000, 1.0), 0.5, 1e-9);
  EXPECT_NEAR(*place_at(1'600'000'000, 1.0), 2.5, 1e-9);
  EXPECT_NEAR(*place_at(1'200'000'000, 0.5), 2.0, 1e-9);
  EXPECT_FALSE(place_at(1'600'000'000, 0.5)) << "0.8 s apart";
}

TEST(PoseInterpolation, TheLastStepGoesOnForItsLength) {
  EXPECT_NEAR(*place_at(2'400'000'000, 1.0), 3.5, 1e-9);
  EXPECT_FALSE(place_at(2'900'000'000, 1.0));
  EXPECT_FALSE(place_at(999'999'999, 1.0)) << "before the first pose";
  EXPECT_FALSE(pose_at({uneven().front()}, Stamp{1'000'000'000}, 1.0)) << "one pose moves nowhere";
}

}  // namespace
}  // namespace dynamic_icp::formats
