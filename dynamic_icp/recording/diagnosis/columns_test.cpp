// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(Columns, ColumnsInAnotherOrderAreFound) {
  Recording first;
  first.perturb = to_doppler_x_y_z;
  const Finding order = diagnosis_of(first).of(Question::kColumns);
  EXPECT_EQ(order.verdict, Verdict::kWrong);
  EXPECT_EQ(order.fix, (Correction{.columns = std::array{1, 2, 3, 0}}));
  Recording upright;
  upright.has_truth = false;
  upright.perturb = [](RawScan& raw, const Vector3d&) {  // stored x, z, y, Doppler
    for (Vector3d& point : raw.points) {
      std::swap(point.y(), point.z());
    }
  };
  EXPECT_EQ(diagnosis_of(upright).of(Question::kColumns).fix, (Correction{.columns = std::array{0, 2, 1, 3}}));
}

TEST(Columns, OfAFlatSensorOnItsSideTheOtherAxisIsUp) {
  Evidence evidence;
  evidence.looks.resize(1);
  evidence.looks[0].points = 1000;
  evidence.looks[0].look_spread = {0.7, 0.1, 0.6};
  evidence.columns.doppler = 3;
  EXPECT_EQ(columns(evidence).verdict, Verdict::kWrong);
  EXPECT_EQ(columns(evidence).fix.columns, (std::array{0, 2, 1, 3}));
  evidence.looks[0].points = 1;
  EXPECT_EQ(columns(evidence).verdict, Verdict::kOk) << "one point is flat whatever it is";
  evidence.looks[0].points = 1000;
  evidence.looks[0].look_spread = {0.6, 0.7, 0.1};
  EXPECT_EQ(columns(evidence).verdict, Verdict::kOk);
}

TEST(Columns, AFixIsOfTheColumnsAsStoredWhateverWasAppliedToThem) {
  Evidence evidence;
  evidence.looks.resize(1);
  evidence.looks[0].points = 1000;
  evidence.looks[0].look_spread = {0.7, 0.1, 0.6};    // the second one is up
  evidence.applied.columns = std::array{3, 2, 1, 0};  // stored Doppler, z, y, x were taken for x, y, z, Doppler
  EXPECT_EQ(columns(evidence).fix.columns, (std::array{3, 1, 2, 0}));
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
