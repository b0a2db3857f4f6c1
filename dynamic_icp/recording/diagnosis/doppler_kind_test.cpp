// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(DopplerKindAnswer, CompensatedDopplerIsFoundWithAndWithoutGroundTruth) {
  for (const bool has_truth : {true, false}) {
    Recording recording;
    recording.has_truth = has_truth;
    recording.perturb = compensate;
    const Diagnosis diagnosis = diagnosis_of(recording);
    EXPECT_EQ(diagnosis.of(Question::kDopplerKind).verdict, Verdict::kWrong) << has_truth;
    EXPECT_EQ(diagnosis.of(Question::kDopplerKind).fix, Correction{.doppler_kind = DopplerKind::kCompensated});
    EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kCannotTell);
  }
}

TEST(DopplerKindAnswer, TheKindIsJudgedAgainstWhatTheLayoutSays) {
  Recording compensated;
  compensated.kind = DopplerKind::kCompensated;
  compensated.perturb = compensate;
  EXPECT_EQ(diagnosis_of(compensated).of(Question::kDopplerKind).verdict, Verdict::kOk);
  Recording relative;
  relative.kind = DopplerKind::kCompensated;
  EXPECT_EQ(diagnosis_of(relative).of(Question::kDopplerKind).fix, Correction{.doppler_kind = DopplerKind::kRelative});
}

TEST(DopplerKindAnswer, AColumnOfZerosIsNoDoppler) {
  const auto kind_of = [](double speed_mps, bool has_truth) {
    Recording recording;
    recording.path = synthetic::circle(speed_mps, 0.0);
    recording.has_truth = has_truth;
    recording.perturb = [](RawScan& raw, const Vector3d&) { raw.doppler.assign(raw.doppler.size(), 0.0); };
    const Diagnosis diagnosis = diagnosis_of(recording);
    const Finding& kind = diagnosis.of(Question::kDopplerKind);
    EXPECT_EQ(diagnosis.has_doppler, kind.verdict != Verdict::kWrong);
    return kind;
  };
  for (const bool has_truth : {true, false}) {
    EXPECT_EQ(kind_of(9.0, has_truth).verdict, Verdict::kWrong);
    EXPECT_EQ(kind_of(9.0, has_truth).fix, Correction{.doppler_kind = DopplerKind::kCompensated});
    EXPECT_EQ(kind_of(0.0, has_truth).verdict, Verdict::kCannotTell) << "without noise it stands still like that";
  }
}

TEST(DopplerKindAnswer, AReflectanceIsNoDoppler) {
  for (const double speed_mps : {0.0, 9.0}) {
    Recording recording;
    recording.path = synthetic::circle(speed_mps, 0.0);
    recording.perturb = [](RawScan& raw, const Vector3d&) {
      for (std::size_t i = 0; i < raw.points.size(); ++i) {
        raw.doppler[i] = 0.5 + 0.45 * std::sin(12.9898 * static_cast<double>(i));
      }
    };
    const Diagnosis diagnosis = diagnosis_of(recording);
    EXPECT_FALSE(diagnosis.has_doppler);
    EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kWrong);
    EXPECT_EQ(diagnosis.of(Question::kDopplerUnits).verdict, Verdict::kCannotTell);
  }
  // All of one sign as well: noise around a constant error, of a sensor that is static.
  Recording biased;
  biased.path = synthetic::circle(0.0, 0.0);
  biased.sensor.bias_mps = 0.5;
  EXPECT_TRUE(diagnosis_of(biased).has_doppler);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
