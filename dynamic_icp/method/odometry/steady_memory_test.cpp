// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// In the long run the default pipeline asks the system for nothing as large as a column of a scan.
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/odometry/window_odometry.hpp"

#include "testing/counted_allocations.hpp"

namespace dynamic_icp::odometry {
namespace {

// A column is larger than the matrices of the estimator, which do not grow with the points.
constexpr std::size_t kPoints = 300'000;

/// A hall seen by a sensor that stands: floor and four walls.
RawScan hall(int k) {
  std::mt19937 random(static_cast<unsigned>(k));
  std::uniform_real_distribution<double> uniform(-12.0, 12.0);
  std::normal_distribution<double> noise(0.0, 0.01);
  RawScan raw;
  raw.stamp = Stamp{1'000'000'000 + 100'000'000LL * k};
  while (raw.points.size() < kPoints) {
    const double a = uniform(random);
    const double height = 0.1 * uniform(random);
    const std::size_t side = raw.points.size() % 5;
    const Eigen::Vector3d places[] = {
        {12.0, a, height}, {-12.0, a, height}, {a, 12.0, height}, {a, -12.0, height}, {a, uniform(random), -2.0}};
    raw.points.emplace_back(places[side] + Eigen::Vector3d(noise(random), noise(random), noise(random)));
    raw.doppler.push_back(0.05 * noise(random));
    raw.times.push_back(0.1 * static_cast<double>(raw.points.size()) / static_cast<double>(kPoints));
  }
  return raw;
}

TEST(SteadyMemory, NothingAsLargeAsAColumnOfAScanIsAllocated) {
  WindowOdometry odometry(WindowOdometryConfig{}, {}, 2);
  constexpr int kWarmUp = 6;
  for (int k = 0; k < kWarmUp + 6; ++k) {
    const RawScan raw = hall(k);
    largest_allocation = 0;
    const Frame frame = odometry.process(raw);
    ASSERT_GT(frame.points_used, 3000u);
    if (k >= kWarmUp) {
      EXPECT_LT(largest_allocation, kPoints * sizeof(double)) << "scan " << k;
    } else if (k == 0) {
      EXPECT_GE(largest_allocation, kPoints * sizeof(double)) << "the count sees the first scan";
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
