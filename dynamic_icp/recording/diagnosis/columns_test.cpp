// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>

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

/// x, y, z as angles per radian and range, these at the places that are named.
void to_spherical(RawScan& raw, double per_radian, const std::array<Eigen::Index, 3>& places) {
  for (Vector3d& point : raw.points) {
    const Vector3d angles_and_range(per_radian * std::atan2(point.y(), point.x()),
                                    per_radian * std::atan2(point.z(), point.head<2>().norm()), point.norm());
    for (Eigen::Index k = 0; k < 3; ++k) {
      point[places.at(static_cast<std::size_t>(k))] = angles_and_range[k];
    }
  }
}

TEST(Columns, SphericalCoordinatesAreFound) {
  const double per_degree = 180.0 / std::acos(-1.0);
  struct Case {
    double per_radian;
    std::array<Eigen::Index, 3> places;
    Correction fix;
  };
  const Case cases[] = {
      {per_degree,
       {0, 1, 2},
       {.columns = std::array{0, 1, 2, 3}, .coordinates = datasets::Coordinates::kSphericalDegrees}},
      {per_degree,
       {1, 2, 0},
       {.columns = std::array{1, 2, 0, 3}, .coordinates = datasets::Coordinates::kSphericalDegrees}},
      {1.0, {0, 1, 2}, {.columns = std::array{0, 1, 2, 3}, .coordinates = datasets::Coordinates::kSphericalRadians}},
      {1.0, {2, 1, 0}, {.columns = std::array{2, 1, 0, 3}, .coordinates = datasets::Coordinates::kSphericalRadians}}};
  for (const Case& one : cases) {
    Recording recording;
    recording.perturb = [&](RawScan& raw, const Vector3d&) { to_spherical(raw, one.per_radian, one.places); };
    const Diagnosis diagnosis = diagnosis_of(recording);
    EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kWrong) << diagnosis.of(Question::kColumns).sentence;
    EXPECT_EQ(diagnosis.of(Question::kColumns).fix, one.fix);
    for (const Question question : {Question::kDopplerSign, Question::kPointUnits, Question::kDopplerUnits}) {
      EXPECT_EQ(diagnosis.of(question).verdict, Verdict::kOk) << diagnosis.of(question).sentence;
    }
  }
}

/// Of a sensor that stands.
Diagnosis at_rest(const std::function<void(RawScan&)>& change) {
  Recording recording;
  recording.perturb = [&](RawScan& raw, const Vector3d&) {
    for (std::size_t i = 0; i < raw.doppler.size(); ++i) {
      raw.doppler[i] = 0.02 * std::sin(12.9898 * static_cast<double>(i));
    }
    change(raw);
  };
  recording.has_truth = false;
  return diagnosis_of(recording);
}

TEST(Columns, DegreesOfASensorAtRestAreSuspected) {
  const double per_degree = 180.0 / std::acos(-1.0);
  for (const std::array<Eigen::Index, 3>& places : {std::array<Eigen::Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 1, 0}}) {
    const Finding finding =
        at_rest([&](RawScan& raw) { to_spherical(raw, per_degree, places); }).of(Question::kColumns);
    EXPECT_EQ(finding.verdict, Verdict::kSuspicious) << finding.sentence;
    const auto place = [&](std::size_t k) { return static_cast<int>(places.at(k)); };
    EXPECT_EQ(finding.fix, (Correction{.columns = std::array{place(0), place(1), place(2), 3},
                                       .coordinates = datasets::Coordinates::kSphericalDegrees}));
  }
  const Finding cartesian = at_rest([](RawScan&) {}).of(Question::kColumns);
  EXPECT_FALSE(cartesian.fix.coordinates) << cartesian.sentence;
}

TEST(Columns, RadiansOfASensorAtRestAreSuspected) {
  for (const std::array<Eigen::Index, 3>& places : {std::array<Eigen::Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 1, 0}}) {
    const Finding finding = at_rest([&](RawScan& raw) { to_spherical(raw, 1.0, places); }).of(Question::kColumns);
    EXPECT_EQ(finding.verdict, Verdict::kSuspicious) << finding.sentence;
    EXPECT_NE(finding.sentence.find("in radians"), std::string::npos) << finding.sentence;
    const auto place = [&](std::size_t k) { return static_cast<int>(places.at(k)); };
    EXPECT_EQ(finding.fix, (Correction{.columns = std::array{place(0), place(1), place(2), 3},
                                       .coordinates = datasets::Coordinates::kSphericalRadians}));
  }
}

TEST(Columns, NoiseOfASensorAtRestInACorridorIsNoMotion) {
  const auto in_corridor = [](RawScan& raw) {
    RawScan few;
    few.stamp = raw.stamp;
    for (std::size_t i = 0; i < raw.points.size(); ++i) {
      if (const Vector3d& p = raw.points[i]; p.x() > 0.0 && std::abs(p.y()) < 1.5 && std::abs(p.z()) < 1.5) {
        few.points.push_back(p);
        few.doppler.push_back(raw.doppler[i]);
      }
    }
    ASSERT_GT(few.points.size(), 20U);
    raw = std::move(few);
  };
  const Finding finding = at_rest(in_corridor).of(Question::kColumns);
  EXPECT_FALSE(finding.fix.coordinates) << finding.sentence;
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

TEST(Columns, WhatMayBeSphericalIsNotCalledASensorOnItsSide) {
  Evidence evidence;
  evidence.looks.resize(1);
  evidence.looks[0].points = 1000;
  evidence.looks[0].look_spread = {0.7, 0.1, 0.6};
  evidence.columns.residual[3] = 1.0;
  evidence.columns.likely_spherical = SphericalColumns{.columns = {1, 2, 0}, .residual = 0.5};
  EXPECT_EQ(columns(evidence).verdict, Verdict::kSuspicious);
  EXPECT_EQ(columns(evidence).fix,
            (Correction{.columns = std::array{1, 2, 0, 3}, .coordinates = datasets::Coordinates::kSphericalDegrees}));
  evidence.columns.likely_spherical->residual = 0.9;
  EXPECT_EQ(columns(evidence).verdict, Verdict::kWrong) << "spherical coordinates explain no more";
  EXPECT_EQ(columns(evidence).fix.columns, (std::array{0, 2, 1, 3}));
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
