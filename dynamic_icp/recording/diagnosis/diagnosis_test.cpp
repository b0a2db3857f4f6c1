// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include <gtest/gtest.h>

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(Diagnosis, AHealthyDriveIsHealthy) {
  Recording recording;
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(not_ok(diagnosis), Verdicts{});
  EXPECT_EQ(diagnosis.findings.size(), 12u);
}

TEST(Diagnosis, IsTheSameForAnyNumberOfThreads) {
  Recording recording;
  recording.has_truth = false;
  const Diagnosis one = diagnosis_of(recording, 1);
  const Diagnosis three = diagnosis_of(recording, 3);
  for (std::size_t k = 0; k < one.findings.size(); ++k) {
    EXPECT_EQ(one.findings[k].sentence, three.findings[k].sentence);
    EXPECT_EQ(one.findings[k].evidence, three.findings[k].evidence);
  }
}

TEST(Diagnosis, ApplyingTheFixesMakesTheDiagnosisClean) {
  const auto backwards_in_kmh = [](RawScan& raw, const Vector3d&) {
    for (double& doppler : raw.doppler) {
      doppler *= -3.6;
    }
  };
  const std::function<void(RawScan&, const Vector3d&)> faults[] = {flip, compensate, backwards_in_kmh, to_millimetres,
                                                                   to_doppler_x_y_z};
  for (const auto& fault : faults) {
    const auto perturbed = [&] {
      auto recording = std::make_unique<Recording>();
      recording->perturb = fault;
      return recording;
    };
    datasets::InputSettings settings;
    for (const Finding& finding : diagnosis_of(perturbed(), {}).findings) {
      apply(finding.fix, settings);
    }
    EXPECT_NE(settings.correction, Correction{});
    for (const Finding& finding : diagnosis_of(perturbed(), settings.correction).findings) {
      EXPECT_NE(finding.verdict, Verdict::kWrong) << finding.sentence;
      EXPECT_NE(finding.verdict, Verdict::kSuspicious) << finding.sentence;
      EXPECT_EQ(finding.fix, Correction{}) << finding.sentence;
    }
  }
}

TEST(Diagnosis, AFixTakesInWhatWasCorrectedWrong) {
  const auto fix = [](Question question, const Correction& wrong) {
    return diagnosis_of(std::make_unique<Recording>(), wrong).of(question).fix;
  };
  EXPECT_EQ(fix(Question::kDopplerSign, {.doppler_sign = DopplerSign::kTowards}),
            Correction{.doppler_sign = DopplerSign::kAway});
  EXPECT_EQ(fix(Question::kDopplerUnits, {.doppler_scale = 3.6}), Correction{.doppler_scale = 1.0});
  EXPECT_EQ(fix(Question::kPointUnits, {.point_scale = 1000.0}), Correction{.point_scale = 1.0});
  EXPECT_EQ(fix(Question::kColumns, {.columns = std::array{3, 0, 1, 2}}), Correction{.columns = Correction::kInOrder});
}

TEST(Diagnosis, EmptyScansAreNoReasonToFail) {
  Recording recording;
  recording.perturb = [](RawScan& raw, const Vector3d&) {
    RawScan empty;
    empty.stamp = raw.stamp;
    raw = empty;
  };
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(diagnosis.of(Question::kUnusablePoints).verdict, Verdict::kWrong);
  EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kCannotTell);
}

TEST(Diagnosis, NothingIsClaimedOfAVehicleThatStands) {
  Recording recording;
  recording.path = synthetic::circle(0.0, 0.0);
  const Diagnosis diagnosis = diagnosis_of(recording);
  for (const Question question :
       {Question::kDopplerSign, Question::kDopplerKind, Question::kMounting, Question::kTimeScale}) {
    EXPECT_EQ(diagnosis.of(question).verdict, Verdict::kCannotTell) << to_string(question);
  }
  EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kOk);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
