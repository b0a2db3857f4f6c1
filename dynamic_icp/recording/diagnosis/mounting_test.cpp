// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

TEST(Mounting, AnAngleIsOnlyToldWhereTheStretchesAgree) {
  Recording recording;
  recording.path = synthetic::circle(10.0, 0.0);
  recording.perturb = [](RawScan& raw, const Vector3d&) {  // another angle after a while
    const double yaw = seconds_between(synthetic::stamp_at(0.0), raw.stamp) < 1.2 ? 0.7 : -0.2;
    for (Vector3d& point : raw.points) {
      point = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * point;
    }
  };
  const Finding mounting = diagnosis_of(recording).of(Question::kMounting);
  EXPECT_EQ(mounting.verdict, Verdict::kCannotTell) << mounting.sentence;
  EXPECT_NE(mounting.sentence.find("scatters"), std::string::npos) << mounting.sentence;
}

TEST(Mounting, ATurnedSensorIsTold) {
  Recording recording;
  const Eigen::AngleAxisd turn(0.5, Vector3d::UnitZ());
  const synthetic::Path straight = synthetic::circle(10.0, 0.0);
  recording.path = [=](double t) { return Eigen::Isometry3d(straight(t) * turn); };
  const Finding mounting = diagnosis_of(recording).of(Question::kMounting);
  EXPECT_EQ(mounting.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(mounting.evidence[0].second, -0.5 * 180.0 / std::numbers::pi, 2.0);
}

/// Looks of straight stretches that move so.
Evidence moving(const Vector3d& velocity) {
  Evidence evidence;
  evidence.looks.resize(3 * kLooksOfStretch);
  for (ScanLook& look : evidence.looks) {
    look.ego.status = ego_motion::EgoVelocityStatus::kConverged;
    look.ego.velocity_sensor = velocity;
    look.static_share = 0.9;
  }
  evidence.matching.motions = evidence.matching.moving = 3;
  evidence.matching.ratio = 1.0;
  return evidence;
}

TEST(Mounting, SaysWhereTheSensorLooks) {
  EXPECT_EQ(mounting(moving({10.0, 0.3, 0.0})).verdict, Verdict::kOk);
  const Finding left = mounting(moving({0.0, 10.0, 0.0}));
  EXPECT_EQ(left.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(left.evidence[0].second, 90.0, 1e-9);
  const Finding back = mounting(moving({-10.0, 0.0, 0.0}));
  EXPECT_NE(back.sentence.find("looks back"), std::string::npos) << back.sentence;
  EXPECT_EQ(mounting(moving({1.0, 0.0, 0.0})).verdict, Verdict::kCannotTell) << "too slow";
}

TEST(Mounting, AGroundTruthWithOtherAxesIsWrong) {
  Evidence evidence = moving({10.0, 0.0, 0.0});
  evidence.truth.motions = evidence.truth.moving = 3;
  evidence.truth.doppler_speed_mps = 10.0;
  evidence.truth.turned_deg = 20.0;
  EXPECT_EQ(mounting(evidence).verdict, Verdict::kWrong);
  evidence.truth.turned_error_deg = 6.0;
  EXPECT_EQ(mounting(evidence).verdict, Verdict::kOk) << "20 degrees are no more than the scatter allows";
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
