// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(DopplerBias, AConstantErrorIsFound) {
  Recording recording;
  recording.sensor.bias_mps = 0.2;
  const Finding bias = diagnosis_of(recording).of(Question::kDopplerBias);
  EXPECT_EQ(bias.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(bias.evidence[0].second, 0.2, 0.03);
}

/// Looks of stretches whose scans all know the velocity, and the bias to a centimetre per second.
Evidence with_biases(const std::vector<double>& biases_mps) {
  Evidence evidence;
  for (const double bias : biases_mps) {
    for (std::size_t k = 0; k < kLooksOfStretch; ++k) {
      ScanLook look;
      look.ego.status = ego_motion::EgoVelocityStatus::kConverged;
      look.ego.bias_mps = bias;
      look.ego.bias_variance = 1e-4;
      look.static_share = 0.9;
      evidence.looks.push_back(look);
    }
  }
  return evidence;
}

TEST(DopplerBias, IsTheMeanOfTheStretchesAndAsCertainAsTheyAgree) {
  const Finding same = doppler_bias(with_biases({0.15, 0.15, 0.15}));
  EXPECT_EQ(same.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(same.evidence[0].second, 0.15, 0.002);
  EXPECT_EQ(same.evidence[2].second, 3.0);
  EXPECT_EQ(doppler_bias(with_biases({0.0, 0.01, -0.01})).verdict, Verdict::kOk);
  EXPECT_EQ(doppler_bias(with_biases({0.5, -0.2, 0.15})).verdict, Verdict::kCannotTell) << "they contradict each other";
  EXPECT_EQ(doppler_bias({}).verdict, Verdict::kCannotTell);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
