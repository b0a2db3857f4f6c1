// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(DopplerUnits, KilometresPerHourAreFound) {
  Recording speed;
  speed.perturb = [](RawScan& raw, const Vector3d&) {
    for (double& doppler : raw.doppler) {
      doppler *= 3.6;
    }
  };
  EXPECT_EQ(diagnosis_of(speed).of(Question::kDopplerUnits).fix, Correction{.doppler_scale = 0.277778});
}

TEST(DopplerUnits, AreTheUsualOneWhoseFactorTheRatioIs) {
  for (const double factor : {3.6, 1000.0, 100.0, 2.23694, 1.94384, 3.28084}) {
    Evidence evidence;
    evidence.looks.resize(1);
    evidence.looks[0].fast_mps = 10.0 * factor;
    evidence.probes.resize(3);
    evidence.truth = {
        .motions = 3, .moving = 3, .reference_speed_mps = 10.0, .doppler_speed_mps = 10.0 * factor, .ratio = factor};
    const Finding finding = doppler_units(evidence);
    EXPECT_EQ(finding.verdict, Verdict::kWrong) << factor;
    EXPECT_NEAR(finding.fix.doppler_scale.value_or(1.0) * factor, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
