// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/diagnosis/questions.hpp"

#include "testing/spoiled_recording.hpp"

namespace dynamic_icp::diagnosis {
namespace {

using synthetic::kAround;
using synthetic::kFrontPair;
using synthetic::Mountings;

constexpr double kDegree = std::numbers::pi / 180.0;

/// A drive of a rig whose scans were put together by `stated`.
struct Drive {
  Mountings rig = kAround;
  Mountings stated = rig;
  synthetic::Path path = synthetic::agile(9.0);
  double doppler_noise_mps = 0.05;
  double direction_error_mps = 0.0;
  std::vector<double> bias_mps = {};
  bool has_truth = true;
};

/// A smooth error by azimuth (in the scan: it turns with the sensor) of this root mean square; a part of it looks like
/// a velocity.
void add_direction_error(RawScan& raw, double rms_mps) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const auto sensor = static_cast<double>(raw.channels.sensor[i]);
    const Vector3d p = raw.mountings[raw.channels.sensor[i]].inverse() * raw.points[i];
    const double azimuth = std::atan2(p.y(), p.x());
    raw.doppler[i] += rms_mps * (std::sin(azimuth + sensor) + std::sin(4.0 * azimuth + 2.0 * sensor));
  }
}

Diagnosis diagnosis_of(const Drive& drive) {
  Recording recording;
  recording.rig = drive.rig;
  recording.rig_bias_mps = drive.bias_mps;
  recording.path = drive.path;
  recording.has_truth = drive.has_truth;
  recording.sensor.columns = 160;
  recording.sensor.rows = 20;
  recording.sensor.doppler_noise_mps = drive.doppler_noise_mps;
  recording.perturb = [&](RawScan& raw, const Vector3d&) {
    add_direction_error(raw, drive.direction_error_mps);
    synthetic::remount(raw, drive.stated);
  };
  const DiagnosisConfig config{.probes = 4, .always_match_scans = false, .search_sweep = false};
  return diagnose(recording.ready(), config, Workers(1));
}

Finding finding_of(const Drive& drive) { return diagnosis_of(drive).of(Question::kRigMountings); }

double number(const Finding& finding, const std::string& name) {
  for (const auto& [key, value] : finding.evidence) {
    if (key == name) {
      return value;
    }
  }
  ADD_FAILURE() << "no " << name << ": " << finding.sentence;
  return std::nan("");
}

bool says(const Finding& finding, const std::string& words) {
  return finding.sentence.find(words) != std::string::npos;
}

Eigen::Isometry3d rotated(const Eigen::Isometry3d& T, const Vector3d& rotation_deg) {
  Eigen::Isometry3d result = T;
  result.linear() = exp_so3(rotation_deg * kDegree) * T.linear();
  return result;
}

TEST(RigMountings, RightOnesAreRight) {
  for (const Mountings& rig : {kAround, kFrontPair}) {
    for (const synthetic::Path& path : {synthetic::agile(9.0), synthetic::circle(10.0, 0.3)}) {
      for (const bool has_truth : {true, false}) {
        const Finding finding = finding_of({.rig = rig, .stated = rig, .path = path, .has_truth = has_truth});
        EXPECT_EQ(finding.verdict, Verdict::kOk) << finding.sentence;
      }
    }
  }
}

TEST(RigMountings, ErrorsOfRealSensorsAreNoReasonToComplain) {
  const Finding finding =
      finding_of({.doppler_noise_mps = 0.14, .direction_error_mps = 0.15, .bias_mps = {0.2, -0.3, 0.1, -0.1}});
  EXPECT_NE(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_NE(finding.verdict, Verdict::kSuspicious) << finding.sentence;
  EXPECT_GT(number(finding, "sensor_0_left_limit_deg"), 3.0) << "their errors pretend as much";
}

TEST(RigMountings, NothingIsClaimedOfAVehicleThatStands) {
  Mountings swapped = kAround;
  std::swap(swapped[1], swapped[2]);
  for (const Mountings& stated : {kAround, swapped}) {
    const Finding finding = finding_of({.stated = stated, .path = synthetic::circle(0.0, 0.0)});
    EXPECT_EQ(finding.verdict, Verdict::kCannotTell) << finding.sentence;
  }
}

TEST(RigMountings, ASensorThatIsTurnedIsNamedWithItsAngle) {
  struct Turned {
    std::size_t sensor;
    double yaw_deg;
  };
  // One that looks aside has the sideways motion along its lines of sight, where a bias counts as well.
  for (const auto& [k, yaw_deg] : {Turned{0, 2.0}, {0, -4.0}, {2, 3.0}, {2, -4.0}, {3, 2.0}, {3, -4.0}}) {
    Drive drive{.path = synthetic::circle(12.0, 0.2)};
    drive.stated[k] = rotated(kAround[k], {0.0, 0.0, yaw_deg});
    const Finding finding = finding_of(drive);
    EXPECT_EQ(finding.verdict, Verdict::kSuspicious) << k << finding.sentence;
    EXPECT_TRUE(says(finding, "sensor " + std::to_string(k) + " moves")) << finding.sentence;
    const std::string name = "sensor_" + std::to_string(k) + "_left";
    EXPECT_NEAR(number(finding, name + "_deg"), yaw_deg, number(finding, name + "_limit_deg")) << k;
    EXPECT_NEAR(number(finding, name + "_deg"), yaw_deg, 0.4) << k;
  }
}

TEST(RigMountings, OfTwoSensorsTheDirectionOfTravelShowsWhichIsWrong) {
  Drive drive{.rig = kFrontPair, .stated = kFrontPair, .path = synthetic::circle(10.0, 0.0)};
  drive.stated[0] = rotated(kFrontPair[0], {0.0, 0.0, 90.0});
  for (const bool has_truth : {true, false}) {
    drive.has_truth = has_truth;
    const Finding finding = finding_of(drive);
    EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
    EXPECT_TRUE(says(finding, "next to sensor 1, sensor 0 moves ")) << finding.sentence;
    EXPECT_TRUE(says(finding, "a quarter turn to the right about its own z axis")) << finding.sentence;
  }
  // Neither moves ahead, and nothing else shows how the vehicle moves.
  drive.stated[1] = rotated(kFrontPair[1], {0.0, 0.0, -90.0});
  const Finding finding = finding_of(drive);
  EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_TRUE(says(finding, "nothing shows which")) << finding.sentence;
}

TEST(RigMountings, SwappedOnesAreFound) {
  Drive drive;
  std::swap(drive.stated[2], drive.stated[3]);
  const Finding finding = finding_of(drive);
  EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_TRUE(says(finding, "sensor 2 moves") && says(finding, "sensor 3 moves")) << finding.sentence;
  EXPECT_TRUE(says(finding, "the mounting of sensor 2") && says(finding, "the mounting of sensor 3"))
      << finding.sentence;
  EXPECT_FALSE(says(finding, "sensor 1 moves")) << finding.sentence;
}

TEST(RigMountings, WhatElseLooksWrongThenIsNotClaimed) {
  Drive drive;
  for (Eigen::Isometry3d& T : drive.stated) {
    T = rotated(T, {0.0, 0.0, 90.0 * static_cast<double>(&T - drive.stated.data())});
  }
  const Diagnosis diagnosis = diagnosis_of(drive);
  EXPECT_EQ(diagnosis.of(Question::kRigMountings).verdict, Verdict::kWrong);
  bool is_set_aside = false;
  for (const Finding& finding : diagnosis.findings) {
    if (finding.question != Question::kRigMountings) {
      EXPECT_NE(finding.verdict, Verdict::kWrong) << to_string(finding.question) << finding.sentence;
      EXPECT_NE(finding.verdict, Verdict::kSuspicious) << to_string(finding.question) << finding.sentence;
      is_set_aside = is_set_aside || says(finding, "before the mountings");
    }
  }
  EXPECT_TRUE(is_set_aside) << "as if nothing else looked wrong";
}

TEST(RigMountings, InvertedOnesAreFound) {
  Mountings rig = kAround;
  rig[0] = rotated(rig[0], {0.0, 0.0, 40.0});
  Drive drive{.rig = rig, .stated = rig};
  for (Eigen::Isometry3d& T : drive.stated) {
    T = T.inverse();
  }
  Finding finding = finding_of(drive);
  EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_TRUE(says(finding, "all agree if each mounting is replaced by its inverse")) << finding.sentence;

  drive.stated = rig;
  drive.stated[1] = rig[1].inverse();
  finding = finding_of(drive);
  EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_TRUE(says(finding, "sensor 1 moves 17") && says(finding, "its inverse")) << finding.sentence;
}

TEST(RigMountings, AQuaternionInTheOtherOrderIsFound) {
  Drive drive;
  for (Eigen::Isometry3d& T : drive.stated) {  // w, x, y, z were read from what is x, y, z, w in the file
    const Eigen::Quaterniond q(T.linear());
    T.linear() = Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix();
  }
  const Finding finding = finding_of(drive);
  EXPECT_EQ(finding.verdict, Verdict::kWrong) << finding.sentence;
  EXPECT_TRUE(says(finding, "its quaternion in the order x, y, z, w")) << finding.sentence;
}

TEST(RigMountings, OneSensorHasNothingToContradict) {
  Recording recording;
  EXPECT_EQ(diagnosis_of(recording).of(Question::kRigMountings).verdict, Verdict::kOk);
  recording.rig = kAround;
  recording.kind = DopplerKind::kCompensated;
  recording.perturb = [](RawScan& raw, const Vector3d&) { raw.doppler_kind = DopplerKind::kCompensated; };
  EXPECT_EQ(diagnosis_of(recording).of(Question::kRigMountings).verdict, Verdict::kCannotTell);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
