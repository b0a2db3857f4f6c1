// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <limits>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(UnusablePoints, PointsThatCannotBeUsedAreCounted) {
  Recording recording;
  recording.perturb = [](RawScan& raw, const Vector3d&) {
    raw.points.resize(raw.points.size() / 4 * 4);
    raw.doppler.resize(raw.points.size());
    for (std::size_t i = 0; i < raw.points.size(); i += 4) {
      raw.points[i].setZero();
      raw.doppler[i + 1] = std::numeric_limits<double>::quiet_NaN();
    }
    raw.points[2].x() = 1e30;
  };
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kOk) << "zeros fit to any velocity, in any column";
  const Finding unusable = diagnosis.of(Question::kUnusablePoints);
  EXPECT_EQ(unusable.evidence[1].second, 0.25 * unusable.evidence[0].second);
  EXPECT_EQ(unusable.evidence[2].first, "implausible");
  EXPECT_GT(unusable.evidence[2].second, 0.0);
  EXPECT_EQ(unusable.evidence[3].second, 0.25 * unusable.evidence[0].second);
}

TEST(UnusablePoints, ManyAreSuspiciousAndNearlyAllAreWrong) {
  const auto verdict = [](std::size_t points, std::size_t at_origin) {
    Evidence evidence;
    evidence.looks.resize(1);
    evidence.looks[0].points = points;
    evidence.looks[0].dropped.zero_range = at_origin;
    return unusable_points(evidence).verdict;
  };
  EXPECT_EQ(verdict(1000, 400), Verdict::kOk) << "rays into the sky";
  EXPECT_EQ(verdict(1000, 600), Verdict::kSuspicious);
  EXPECT_EQ(verdict(1000, 999), Verdict::kWrong);
  EXPECT_EQ(verdict(0, 0), Verdict::kWrong);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
