// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/likely_extent.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr SeenExtent kWidth{1.0, 1.0, true, true};
constexpr SeenExtent kHeight{1.0, 1.5, true, true};

TEST(LikelyExtents, OfABodySeenFromEndToEndNothingIsGuessed) {
  const auto [along, across, up] = likely_extents({SeenExtent{3.0, 2.0, true, true}, kWidth, kHeight}, true, false);
  EXPECT_DOUBLE_EQ(along.size, 5.0);
  EXPECT_DOUBLE_EQ(along.middle, 0.5);
  EXPECT_DOUBLE_EQ(along.weight_high, 0.5);
  EXPECT_DOUBLE_EQ(along.weight_low, 0.5);
  EXPECT_DOUBLE_EQ(across.size, 2.0);
  EXPECT_DOUBLE_EQ(up.size, 2.5);
  EXPECT_DOUBLE_EQ(up.middle, -0.25);
}

TEST(LikelyExtents, WhatIsHiddenLiesBeyondTheEndThatIsNotSeen) {
  const double typical = typical_length(2.0, 2.5).mean;
  const LikelyExtent behind = likely_extents({SeenExtent{1.0, 0.0, true, false}, kWidth, kHeight}, true, false)[0];
  EXPECT_NEAR(behind.size, typical, 1e-9);
  EXPECT_NEAR(behind.middle, 1.0 - 0.5 * typical, 1e-9);
  EXPECT_DOUBLE_EQ(behind.weight_high, 1.0);
  const LikelyExtent ahead = likely_extents({SeenExtent{0.0, 1.0, false, true}, kWidth, kHeight}, true, false)[0];
  EXPECT_NEAR(ahead.middle, -behind.middle, 1e-9);
  EXPECT_DOUBLE_EQ(ahead.weight_low, 1.0);
  const LikelyExtent anywhere = likely_extents({SeenExtent{0.5, 0.5, false, false}, kWidth, kHeight}, true, false)[0];
  EXPECT_NEAR(anywhere.middle, 0.0, 1e-9);
  EXPECT_NEAR(anywhere.variance, (typical - 1.0) * (typical - 1.0) / 12.0 + 0.25 * typical_length(2.0, 2.5).variance,
              1e-6)
      << "evenly spread over what is missing, and the length itself";
}

TEST(LikelyExtents, WhatIsHiddenIsAnywhereInTheRoomThereIs) {
  const double typical = typical_length(2.0, 2.5).mean;
  SeenExtent end{0.0, 3.0, false, true};
  const auto likely = [&] { return likely_extents({end, kWidth, kHeight}, true, false)[0]; };
  end.room_high = typical;
  EXPECT_NEAR(likely().size, typical, 1e-9) << "there is enough";
  end.room_high = 1.0;
  EXPECT_NEAR(likely().size, 3.5, 1e-9);
  EXPECT_NEAR(likely().middle, -3.0 + 0.5 * 3.5, 1e-9);
  end.room_high = 0.0;
  EXPECT_NEAR(likely().size, 3.0, 1e-9);
  end.room_high = kUnlimited_m;
  end.room_low = 0.0;
  EXPECT_NEAR(likely().size, typical, 1e-9) << "that end was seen";
  // Where neither end was seen, what there is no room for on one side is on the other.
  end = {0.5, 0.5, false, false};
  end.room_high = 0.2;
  EXPECT_NEAR(likely().size, typical, 1e-9);
  EXPECT_NEAR(likely().middle, 0.7 - 0.5 * typical, 1e-9);
  end.room_low = 0.4;
  EXPECT_NEAR(likely().size, 1.3, 1e-9);
  EXPECT_LE(likely().middle + 0.5 * likely().size, 0.7 + 1e-9);
  EXPECT_GE(likely().middle - 0.5 * likely().size, -0.9 - 1e-9);
}

TEST(LikelyExtents, AHeightThatIsNotKnownMakesTheLengthUncertain) {
  const SeenExtent rear{0.0, 0.2, false, true};
  const SeenExtent cut{1.0, 1.5, false, true};
  const double known = likely_extents({rear, kWidth, kHeight}, true, false)[0].variance;
  const double cut_off = likely_extents({rear, kWidth, cut}, true, false)[0].variance;
  // By how much the typical length grows with the height, by differences.
  const double slope = (typical_length(2.0, 2.51).mean - typical_length(2.0, 2.49).mean) / 0.02;
  EXPECT_NEAR(cut_off - known, 0.25 * slope * slope * 0.5 * 0.5, 0.01 * cut_off);
}

TEST(LikelyExtents, APartBetweenOtherThingsMayBeAHood) {
  const SeenExtent part{0.5, 1.0, true, false};
  const SeenExtent hood{0.3, 0.6, true, true};
  const auto [along, across, up] = likely_extents({part, part, hood}, true, false);
  EXPECT_GT(up.size, 1.3) << "no vehicle is lower";
  EXPECT_NEAR(up.middle - 0.5 * up.size, -0.6, 1e-9) << "it stands where it stands";
  EXPECT_GT(along.size, typical_length(1.5, 1.3).mean) << "of a car, not of a hood";
  EXPECT_GT(up.variance, 0.2 * 0.2);
  // Where one side is seen from end to end, so is what is above it.
  EXPECT_DOUBLE_EQ(likely_extents({part, kWidth, hood}, true, false)[2].size, 0.9);
  EXPECT_DOUBLE_EQ(likely_extents({SeenExtent{1.0, 1.0, true, true}, part, hood}, true, false)[2].size, 0.9);
  const SeenExtent lorry{1.0, 1.5, true, true};
  EXPECT_DOUBLE_EQ(likely_extents({part, part, lorry}, true, false)[2].size, 2.5) << "at least what is seen";
}

TEST(LikelyExtents, OfPeopleAndBodiesWithoutHeadingWhatIsSeenIsTheSize) {
  const SeenExtent part{0.3, 0.3, false, false};
  for (const bool has_heading : {false, true}) {
    const auto extents = likely_extents({part, part, kHeight}, has_heading, true);
    EXPECT_DOUBLE_EQ(extents[0].size, 0.6);
    EXPECT_DOUBLE_EQ(extents[1].size, 0.6);
    EXPECT_DOUBLE_EQ(extents[0].variance, 0.0) << "a person";
  }
  const auto extents = likely_extents({part, part, kHeight}, false, false);
  EXPECT_DOUBLE_EQ(extents[0].size, 0.6);
  EXPECT_NEAR(std::sqrt(extents[0].variance), 0.5 * typical_width_by_height(2.5).mean, 1e-9) << "a part of a vehicle";
}

TEST(LikelyExtents, WhatTheViewCutsOffIsAsHighAsVehiclesMayBe) {
  SeenExtent cut{1.0, 1.5, false, true};
  cut.is_cut_high = true;
  const LikelyExtent up = likely_extents({SeenExtent{1.0, 1.0, false, true}, kWidth, cut}, true, false)[2];
  EXPECT_NEAR(up.size, 0.5 * (2.5 + 4.0), 1e-9);
  EXPECT_NEAR(up.middle - 0.5 * up.size, -1.5, 1e-9) << "it stands where it stands";
  EXPECT_GT(up.variance, 0.25 * 1.5 * 1.5 / 12.0) << "evenly spread from what is seen to what roads allow";
  SeenExtent higher{3.0, 1.5, false, true};
  higher.is_cut_high = true;
  EXPECT_NEAR(likely_extents({kWidth, kWidth, higher}, true, false)[2].size, 4.5, 1e-9)
      << "more than it shows is not said";
  EXPECT_NEAR(likely_extents({kWidth, kWidth, cut}, true, true)[2].size, 2.5, 1e-9) << "nor of a person";
}

}  // namespace
}  // namespace dynamic_icp::tracking
