// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(PointUnits, MillimetresAreFound) {
  Recording points;
  points.perturb = to_millimetres;
  const Diagnosis diagnosis = diagnosis_of(points);
  EXPECT_EQ(diagnosis.of(Question::kPointUnits).fix, Correction{.point_scale = 0.001});
  EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kOk) << "the rest is looked at in metres";
}

TEST(PointUnits, KilometresAreFoundAndNoOtherColumnIsBlamed) {
  for (const bool has_truth : {true, false}) {
    Recording points;
    points.has_truth = has_truth;
    points.perturb = [](RawScan& raw, const Vector3d&) {
      for (Vector3d& point : raw.points) {
        point *= 0.001;
      }
    };
    const Diagnosis diagnosis = diagnosis_of(points);
    EXPECT_EQ(diagnosis.of(Question::kPointUnits).fix, Correction{.point_scale = 1000.0});
    EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kOk) << diagnosis.of(Question::kColumns).sentence;
  }
}

// Without ground truth: that scans follow each other a third as fast as assumed would look the same.
TEST(PointUnits, FeetAreSuspectedByTheDoppler) {
  Recording points;
  points.has_truth = false;
  points.perturb = [](RawScan& raw, const Vector3d&) {
    for (Vector3d& point : raw.points) {
      point *= 3.28084;
    }
  };
  const Finding units = diagnosis_of(points).of(Question::kPointUnits);
  EXPECT_EQ(units.verdict, Verdict::kSuspicious) << units.sentence;
  EXPECT_EQ(units.fix, Correction{.point_scale = 0.3048});
}

TEST(PointUnits, CentimetresAndFeetAreToldByTheWay) {
  for (const auto& [per_metre, scale] : {std::pair(100.0, 0.01), std::pair(3.28084, 0.3048)}) {
    Recording points;
    points.perturb = [per_metre = per_metre](RawScan& raw, const Vector3d&) {
      for (Vector3d& point : raw.points) {
        point *= per_metre;
      }
    };
    const Finding units = diagnosis_of(points).of(Question::kPointUnits);
    EXPECT_EQ(units.verdict, Verdict::kWrong) << per_metre;
    EXPECT_NEAR(units.fix.point_scale.value_or(1.0), scale, 0.05 * scale) << per_metre;
  }
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
