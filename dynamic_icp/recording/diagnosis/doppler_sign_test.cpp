// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(DopplerSignAnswer, ATurnedSignIsFoundWithAndWithoutGroundTruth) {
  for (const bool has_truth : {true, false}) {
    Recording recording;
    recording.has_truth = has_truth;
    recording.perturb = flip;
    const Finding sign = diagnosis_of(recording).of(Question::kDopplerSign);
    EXPECT_EQ(sign.verdict, Verdict::kWrong) << has_truth << sign.sentence;
    EXPECT_EQ(sign.fix, (Correction{.doppler_sign = DopplerSign::kTowards}));
  }
}

TEST(DopplerSignAnswer, ASmoothTunnelWithoutGroundTruthTellsNoSign) {
  for (const bool is_flipped : {false, true}) {
    Recording recording;
    recording.world = synthetic::tunnel();
    recording.path = synthetic::circle(15.0, 0.0);
    recording.has_truth = false;
    if (is_flipped) {
      recording.perturb = flip;
    }
    const Finding sign = diagnosis_of(recording).of(Question::kDopplerSign);
    EXPECT_EQ(sign.verdict, Verdict::kCannotTell) << sign.sentence;
    EXPECT_NE(sign.sentence.find("assumed"), std::string::npos);
  }
}

TEST(DopplerSignAnswer, WhereNoScansMatchASignMayBeATurnOfTheSensor) {
  Recording recording;
  recording.world = synthetic::tunnel();
  recording.path = synthetic::circle(15.0, 0.0);
  recording.perturb = [](RawScan& raw, const Vector3d&) {  // back to front, against the ground truth
    for (Vector3d& point : raw.points) {
      point = {-point.x(), -point.y(), point.z()};
    }
  };
  const Finding sign = diagnosis_of(recording).of(Question::kDopplerSign);
  EXPECT_EQ(sign.verdict, Verdict::kWrong) << sign.sentence;
  EXPECT_NE(sign.sentence.find("or points and Doppler are right and the sensor is turned by 180 degrees"),
            std::string::npos)
      << sign.sentence;
}

TEST(DopplerSignAnswer, AJamIsNoTurnedSign) {
  // Three motions of a drive among traffic that is faster.
  Evidence evidence;
  evidence.matching = {.motions = 3,
                       .moving = 3,
                       .reference_speed_mps = 3.2,
                       .doppler_speed_mps = 2.0,
                       .ratio = -0.57,
                       .ratio_error = 0.28,
                       .turned_deg = 165.0};
  EXPECT_EQ(doppler_sign(evidence).verdict, Verdict::kCannotTell);
  evidence.matching.ratio_error = 0.05;
  EXPECT_EQ(doppler_sign(evidence).verdict, Verdict::kWrong);
  evidence.matching.motions = evidence.matching.moving = 1;
  evidence.matching.ratio_error = 0.0;
  EXPECT_EQ(doppler_sign(evidence).verdict, Verdict::kCannotTell);
  evidence.matching.ratio = -0.95;
  EXPECT_EQ(doppler_sign(evidence).verdict, Verdict::kWrong);
}

TEST(DopplerSignAnswer, WhatCannotBeToldIsSaidWithoutContradiction) {
  Recording stationary;
  stationary.path = synthetic::circle(0.0, 0.0);
  EXPECT_NE(diagnosis_of(stationary).of(Question::kDopplerSign).sentence.find("too slow to decide"), std::string::npos);
  Recording compensated;
  compensated.perturb = compensate;
  const std::string sentence = diagnosis_of(compensated).of(Question::kDopplerSign).sentence;
  EXPECT_EQ(sentence.find("too slow"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("m/s where the sensor moves at"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
