// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(TimeScale, AWrongGroundTruthIsNotBlamedOnTheClock) {
  Recording recording;
  recording.truth_scale = 2.0;
  const Finding clock = diagnosis_of(recording).of(Question::kTimeScale);
  EXPECT_EQ(clock.verdict, Verdict::kSuspicious) << clock.sentence;
  EXPECT_EQ(clock.fix, Correction{});
  EXPECT_NE(clock.sentence.find("ground truth"), std::string::npos) << clock.sentence;
}

TEST(TimeScale, StampsThatRunFastAreFound) {
  Recording recording;
  recording.stamp_factor = 1.2;
  const Finding scale = diagnosis_of(recording).of(Question::kTimeScale);
  EXPECT_EQ(scale.verdict, Verdict::kWrong);
  EXPECT_NEAR(scale.fix.time_scale.value_or(1.0), 1.0 / 1.2, 0.03);
}

TEST(TimeScale, IsTheRatioOfTheSpeedsOnTopOfWhatWasApplied) {
  Evidence evidence;
  evidence.probes.resize(3);
  evidence.matching = {.motions = 3, .moving = 3, .reference_speed_mps = 10.0, .doppler_speed_mps = 15.0, .ratio = 1.5};
  evidence.applied.time_scale = 3.0;
  const Finding finding = time_scale(evidence);
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_EQ(finding.fix, Correction{.time_scale = 2.0});
  evidence.matching.ratio_error = 0.15;
  EXPECT_EQ(time_scale(evidence).verdict, Verdict::kOk) << "within four standard errors";
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
