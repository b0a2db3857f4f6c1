// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/vehicle_sizes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kVan(5.6, 2.0, 2.4);
constexpr std::array<Belief, 3> kAny{Belief{6.5, 0.9}, Belief{1.9, 0.1}, Belief{1.5, 0.25}};
constexpr SeenSize kWide{2.0, true};
constexpr SeenSize kHigh{2.4, true};

TEST(VehicleSizes, WithoutOthersWhatIsLikelyOfAnyIsLikely) {
  const auto [length, width, height] = VehicleSizes{}.complete({SeenSize{1.0, false}, kWide, kHigh}, kAny);
  EXPECT_EQ(length.mean, kAny[0].mean);
  EXPECT_EQ(length.variance, kAny[0].variance);
}

TEST(VehicleSizes, WhatResemblesAVehicleIsAsLong) {
  VehicleSizes sizes;
  sizes.note(1, kVan);
  const auto [length, width, height] = sizes.complete({SeenSize{1.0, false}, kWide, kHigh}, kAny);
  EXPECT_NEAR(length.mean, 5.6, 1e-9);
  EXPECT_LT(length.variance, kAny[0].variance);
  EXPECT_EQ(width.mean, kAny[1].mean) << "what was seen is left alone";
  const Belief low = sizes.complete({SeenSize{5.6, true}, kWide, SeenSize{1.0, false}}, kAny)[2];
  EXPECT_NEAR(low.mean, 2.4, 1e-9) << "of which the top is hidden";
}

TEST(VehicleSizes, WhatResemblesNoneIsAsAny) {
  VehicleSizes sizes;
  sizes.note(1, kVan);
  const auto length_of = [&](const SeenSize& length, const SeenSize& width, const SeenSize& height) {
    return sizes.complete({length, width, height}, kAny)[0].mean;
  };
  EXPECT_EQ(length_of({1.0, false}, {1.7, true}, {1.5, true}), kAny[0].mean) << "a car";
  EXPECT_EQ(length_of({8.0, false}, kWide, kHigh), kAny[0].mean) << "so much was seen of it already";
  EXPECT_EQ(length_of({0.5, false}, {0.5, false}, {0.5, false}), kAny[0].mean) << "this may be a part of anything";
}

TEST(VehicleSizes, OfSeveralTheMedianCounts) {
  // By the densities: what was seen is as likely of either, and less likely of another vehicle.
  VehicleSizes sizes;
  sizes.note(1, {4.4, 2.0, 2.4});
  sizes.note(2, {4.8, 2.0, 2.4});
  const Belief length = sizes.complete({SeenSize{1.0, false}, kWide, kHigh}, kAny)[0];
  const double weight = 1.0 / (2.0 * std::numbers::pi * 0.07 * 0.07);  // of each, where any has 1
  EXPECT_NEAR(length.mean, 4.8, 1e-9) << "4.4 has less than half of the weight";
  const double sum = 2.0 * weight + 1.0;
  const double expected = (weight * 0.4 * 0.4 + 2.0 * weight * 0.01 * 4.8 * 4.8 + 1.7 * 1.7 + 0.9) / sum;
  EXPECT_NEAR(length.variance, expected, 1e-6);
}

TEST(VehicleSizes, TheLastThatWasSaidOfAVehicleCounts) {
  VehicleSizes sizes;
  sizes.note(1, {4.4, 2.0, 2.4});
  sizes.note(1, kVan);
  EXPECT_NEAR(sizes.complete({SeenSize{1.0, false}, kWide, kHigh}, kAny)[0].mean, 5.6, 1e-9);
}

TEST(VehicleSizes, WhatIsNoVehicleIsNotNoted) {
  VehicleSizes sizes;
  sizes.note(1, {5.6, 2.0, 0.0});
  sizes.note(2, {200.0, 2.0, 2.4});
  const auto all = sizes.complete({SeenSize{1.0, false}, kWide, SeenSize{0.0, false}}, kAny);
  EXPECT_EQ(all[0].mean, kAny[0].mean);
  EXPECT_EQ(all[2].mean, kAny[2].mean);
}

TEST(VehicleSizes, OldVehiclesMakeRoomForNewOnes) {
  VehicleSizes sizes;
  sizes.note(1, kVan);
  for (std::int64_t id = 2; id < 200; ++id) {
    sizes.note(id, {10.0, 2.5, 3.6});
  }
  EXPECT_EQ(sizes.complete({SeenSize{1.0, false}, kWide, kHigh}, kAny)[0].mean, kAny[0].mean);
  EXPECT_NEAR(sizes.complete({SeenSize{1.0, false}, {2.5, true}, {3.6, true}}, kAny)[0].mean, 10.0, 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::tracking
