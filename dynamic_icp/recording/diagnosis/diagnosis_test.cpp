// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "dynamic_icp/recording/datasets/input_settings.hpp"

#include "testing/synthetic_street.hpp"

namespace dynamic_icp::diagnosis {
namespace {

namespace synthetic = odometry::synthetic;
using datasets::Correction;
using datasets::DopplerSign;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.1;
constexpr std::size_t kScans = 25;

/// A drive by equations, spoiled on the way out.
class Recording final : public datasets::Dataset {
 public:
  synthetic::World world = synthetic::street_with_cars();
  synthetic::Path path = synthetic::lively(9.0);
  synthetic::Sensor sensor;
  bool has_truth = true;
  double truth_scale = 1.0;
  double stamp_factor = 1.0;
  DopplerKind kind = DopplerKind::kRelative;
  std::function<void(RawScan&, const Vector3d& velocity)> spoil = [](RawScan&, const Vector3d&) {};

  /// Once all is set.
  Recording& ready() {
    for (std::size_t i = 0; has_truth && i < kScans; ++i) {
      truth_.push_back({stamp(i), path(static_cast<double>(i) * kPeriod_s)});
      truth_.back().T_world_sensor.translation() *= truth_scale;
    }
    return *this;
  }

  [[nodiscard]] std::string_view format() const override { return "test"; }
  [[nodiscard]] std::size_t size() const override { return kScans; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override {
    return synthetic::stamp_at(stamp_factor * static_cast<double>(index) * kPeriod_s);
  }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t) const override { return "scan"; }
  [[nodiscard]] RawScan scan(std::size_t index) const override {
    const double time_s = static_cast<double>(index) * kPeriod_s;
    RawScan raw = synthetic::scan_at(world, path, sensor, time_s).raw;
    raw.stamp = stamp(index);
    spoil(raw, synthetic::velocity_sensor(path, time_s));
    return raw;
  }
  [[nodiscard]] DopplerKind doppler_kind() const override { return kind; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return none_; }

 private:
  formats::Trajectory truth_;
  std::vector<std::string> none_;
};

Diagnosis diagnosis_of(Recording& recording, int threads = 1) {
  DoctorConfig config;
  config.probes = 4;
  return diagnose(recording.ready(), config, Workers(threads));
}

/// The verdicts that are not "ok", by question.
std::map<std::string, std::string> not_ok(const Diagnosis& diagnosis) {
  std::map<std::string, std::string> verdicts;
  for (const Finding& finding : diagnosis.findings) {
    if (finding.verdict != Verdict::kOk) {
      verdicts[std::string(to_string(finding.question))] = to_string(finding.verdict);
    }
  }
  return verdicts;
}

using Verdicts = std::map<std::string, std::string>;

void flip(RawScan& raw, const Vector3d&) {
  for (double& doppler : raw.doppler) {
    doppler = -doppler;
  }
}

void compensate(RawScan& raw, const Vector3d& velocity) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    raw.doppler[i] += raw.points[i].normalized().dot(velocity);
  }
}

TEST(Diagnosis, AHealthyDriveIsHealthy) {
  Recording recording;
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(not_ok(diagnosis), (Verdicts{{"point_times", "cannot_tell"}}));
  EXPECT_EQ(diagnosis.findings.size(), 11u);
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

TEST(Diagnosis, ATurnedSignIsFoundWithAndWithoutGroundTruth) {
  for (const bool has_truth : {true, false}) {
    Recording recording;
    recording.has_truth = has_truth;
    recording.spoil = flip;
    const Finding sign = diagnosis_of(recording).of(Question::kDopplerSign);
    EXPECT_EQ(sign.verdict, Verdict::kWrong) << has_truth << sign.sentence;
    EXPECT_EQ(sign.fix, (Correction{.doppler_sign = DopplerSign::kTowards}));
  }
}

TEST(Diagnosis, ApplyingTheFixesMakesTheDiagnosisClean) {
  const std::function<void(RawScan&, const Vector3d&)> faults[] = {
      flip, compensate,
      [](RawScan& raw, const Vector3d&) {  // km/h, and the wrong way round
        for (double& doppler : raw.doppler) {
          doppler *= -3.6;
        }
      },
      [](RawScan& raw, const Vector3d&) {  // millimetres
        for (Vector3d& point : raw.points) {
          point *= 1000.0;
        }
      },
      [](RawScan& raw, const Vector3d&) {  // stored Doppler, x, y, z
        for (std::size_t i = 0; i < raw.points.size(); ++i) {
          const Vector3d p = raw.points[i];
          raw.points[i] = {raw.doppler[i], p.x(), p.y()};
          raw.doppler[i] = p.z();
        }
      }};
  DoctorConfig config;
  config.probes = 4;
  for (const auto& fault : faults) {
    const auto spoiled = [&] {
      auto recording = std::make_unique<Recording>();
      recording->spoil = fault;
      recording->ready();
      return recording;
    };
    datasets::InputSettings settings;
    for (const Finding& finding : diagnose(*spoiled(), config, Workers(1)).findings) {
      apply(finding.fix, settings);
    }
    EXPECT_NE(settings.correction, Correction{});
    config.applied = settings.correction;
    const Diagnosis after = diagnose(*datasets::corrected(spoiled(), settings.correction), config, Workers(1));
    config.applied = {};
    for (const Finding& finding : after.findings) {
      EXPECT_NE(finding.verdict, Verdict::kWrong) << finding.sentence;
      EXPECT_NE(finding.verdict, Verdict::kSuspicious) << finding.sentence;
      EXPECT_EQ(finding.fix, Correction{}) << finding.sentence;
    }
  }
}

TEST(Diagnosis, AFixTakesInWhatWasMendedWrong) {
  const auto fix = [](Question question, const Correction& correction) {
    auto recording = std::make_unique<Recording>();
    recording->ready();
    DoctorConfig config;
    config.probes = 4;
    config.applied = correction;
    return diagnose(*datasets::corrected(std::move(recording), correction), config, Workers(1)).of(question).fix;
  };
  Correction correction;
  correction.doppler_sign = DopplerSign::kTowards;
  EXPECT_EQ(fix(Question::kDopplerSign, correction), Correction{.doppler_sign = DopplerSign::kAway});
  correction = {};
  correction.doppler_scale = 3.6;
  EXPECT_EQ(fix(Question::kDopplerUnits, correction), Correction{.doppler_scale = 1.0});
  correction = {};
  correction.point_scale = 1000.0;
  EXPECT_EQ(fix(Question::kPointUnits, correction), Correction{.point_scale = 1.0});
  correction = {};
  correction.columns = std::array{3, 0, 1, 2};
  EXPECT_EQ(fix(Question::kColumns, correction), Correction{.columns = Correction::kInOrder});
}

TEST(Diagnosis, CompensatedDopplerIsFoundWithAndWithoutGroundTruth) {
  for (const bool has_truth : {true, false}) {
    Recording recording;
    recording.has_truth = has_truth;
    recording.spoil = compensate;
    const Diagnosis diagnosis = diagnosis_of(recording);
    EXPECT_EQ(diagnosis.of(Question::kDopplerKind).verdict, Verdict::kWrong) << has_truth;
    EXPECT_EQ(diagnosis.of(Question::kDopplerKind).fix, Correction{.doppler_kind = DopplerKind::kCompensated});
    EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kCannotTell);
  }
}

TEST(Diagnosis, TheKindIsJudgedAgainstWhatTheLayoutSays) {
  Recording compensated;
  compensated.kind = DopplerKind::kCompensated;
  compensated.spoil = compensate;
  EXPECT_EQ(diagnosis_of(compensated).of(Question::kDopplerKind).verdict, Verdict::kOk);
  Recording relative;
  relative.kind = DopplerKind::kCompensated;
  EXPECT_EQ(diagnosis_of(relative).of(Question::kDopplerKind).fix, Correction{.doppler_kind = DopplerKind::kRelative});
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

TEST(Diagnosis, ASmoothTunnelWithoutGroundTruthTellsNoSign) {
  for (const bool is_flipped : {false, true}) {
    Recording recording;
    recording.world = synthetic::tunnel();
    recording.path = synthetic::circle(15.0, 0.0);
    recording.has_truth = false;
    if (is_flipped) {
      recording.spoil = flip;
    }
    const Finding sign = diagnosis_of(recording).of(Question::kDopplerSign);
    EXPECT_EQ(sign.verdict, Verdict::kCannotTell) << sign.sentence;
    EXPECT_NE(sign.sentence.find("assumed"), std::string::npos);
  }
}

TEST(Diagnosis, WhereNoScansMatchASignMayBeATurnOfTheSensor) {
  Recording recording;
  recording.world = synthetic::tunnel();
  recording.path = synthetic::circle(15.0, 0.0);
  recording.spoil = [](RawScan& raw, const Vector3d&) {  // back to front, against the ground truth
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

TEST(Diagnosis, WhatCannotBeToldIsSaidWithoutContradiction) {
  Recording standing;
  standing.path = synthetic::circle(0.0, 0.0);
  EXPECT_NE(diagnosis_of(standing).of(Question::kDopplerSign).sentence.find("too slow to tell"), std::string::npos);
  Recording compensated;
  compensated.spoil = compensate;
  const std::string sentence = diagnosis_of(compensated).of(Question::kDopplerSign).sentence;
  EXPECT_EQ(sentence.find("too slow"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("m/s where the sensor moves at"), std::string::npos) << sentence;
}

TEST(Diagnosis, AColumnOfZerosIsNoDoppler) {
  const auto kind_of = [](double speed_mps, bool has_truth) {
    Recording recording;
    recording.path = synthetic::circle(speed_mps, 0.0);
    recording.has_truth = has_truth;
    recording.spoil = [](RawScan& raw, const Vector3d&) { raw.doppler.assign(raw.doppler.size(), 0.0); };
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

TEST(Diagnosis, AReflectanceIsNoDoppler) {
  for (const double speed_mps : {0.0, 9.0}) {
    Recording recording;
    recording.path = synthetic::circle(speed_mps, 0.0);
    recording.spoil = [](RawScan& raw, const Vector3d&) {
      for (std::size_t i = 0; i < raw.points.size(); ++i) {
        raw.doppler[i] = 0.5 + 0.45 * std::sin(12.9898 * static_cast<double>(i));
      }
    };
    const Diagnosis diagnosis = diagnosis_of(recording);
    EXPECT_FALSE(diagnosis.has_doppler);
    EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kWrong);
    EXPECT_EQ(diagnosis.of(Question::kDopplerUnits).verdict, Verdict::kCannotTell);
  }
  // All of one sign as well: noise around a constant error, of a sensor that stands still.
  Recording biased;
  biased.path = synthetic::circle(0.0, 0.0);
  biased.sensor.bias_mps = 0.5;
  EXPECT_TRUE(diagnosis_of(biased).has_doppler);
}

TEST(Diagnosis, AnAngleIsOnlyToldWhereTheStretchesAgree) {
  Recording recording;
  recording.path = synthetic::circle(10.0, 0.0);
  recording.spoil = [](RawScan& raw, const Vector3d&) {  // another angle after a while
    const double yaw = seconds_between(synthetic::stamp_at(0.0), raw.stamp) < 1.2 ? 0.7 : -0.2;
    for (Vector3d& point : raw.points) {
      point = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * point;
    }
  };
  const Finding mounting = diagnosis_of(recording).of(Question::kMounting);
  EXPECT_EQ(mounting.verdict, Verdict::kCannotTell) << mounting.sentence;
  EXPECT_NE(mounting.sentence.find("scatters"), std::string::npos) << mounting.sentence;
}

TEST(Diagnosis, AConstantErrorIsFound) {
  Recording recording;
  recording.sensor.bias_mps = 0.2;
  const Finding bias = diagnosis_of(recording).of(Question::kDopplerBias);
  EXPECT_EQ(bias.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(bias.evidence[0].second, 0.2, 0.03);
}

TEST(Diagnosis, KilometresPerHourAndMillimetresAreFound) {
  Recording speed;
  speed.spoil = [](RawScan& raw, const Vector3d&) {
    for (double& doppler : raw.doppler) {
      doppler *= 3.6;
    }
  };
  EXPECT_EQ(diagnosis_of(speed).of(Question::kDopplerUnits).fix, Correction{.doppler_scale = 0.277778});
  Recording points;
  points.spoil = [](RawScan& raw, const Vector3d&) {
    for (Vector3d& point : raw.points) {
      point *= 1000.0;
    }
  };
  const Diagnosis diagnosis = diagnosis_of(points);
  EXPECT_EQ(diagnosis.of(Question::kPointUnits).fix, Correction{.point_scale = 0.001});
  EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kOk) << "the rest is looked at in metres";
}

TEST(Diagnosis, CentimetresAndFeetAreToldByTheWay) {
  for (const auto& [per_metre, scale] : {std::pair(100.0, 0.01), std::pair(3.28084, 0.3048)}) {
    Recording points;
    points.spoil = [per_metre = per_metre](RawScan& raw, const Vector3d&) {
      for (Vector3d& point : raw.points) {
        point *= per_metre;
      }
    };
    const Finding units = diagnosis_of(points).of(Question::kPointUnits);
    EXPECT_EQ(units.verdict, Verdict::kWrong) << per_metre;
    EXPECT_NEAR(units.fix.point_scale.value_or(1.0), scale, 0.05 * scale) << per_metre;
  }
}

TEST(Diagnosis, AWrongGroundTruthIsNotBlamedOnTheClock) {
  Recording recording;
  recording.truth_scale = 2.0;
  const Finding clock = diagnosis_of(recording).of(Question::kTimeScale);
  EXPECT_EQ(clock.verdict, Verdict::kSuspicious) << clock.sentence;
  EXPECT_EQ(clock.fix, Correction{});
  EXPECT_NE(clock.sentence.find("ground truth"), std::string::npos) << clock.sentence;
}

TEST(Diagnosis, ColumnsInAnotherOrderAreFound) {
  Recording first;
  first.spoil = [](RawScan& raw, const Vector3d&) {  // stored Doppler, x, y, z
    for (std::size_t i = 0; i < raw.points.size(); ++i) {
      const Vector3d p = raw.points[i];
      raw.points[i] = {raw.doppler[i], p.x(), p.y()};
      raw.doppler[i] = p.z();
    }
  };
  const Finding order = diagnosis_of(first).of(Question::kColumns);
  EXPECT_EQ(order.verdict, Verdict::kWrong);
  EXPECT_EQ(order.fix, (Correction{.columns = std::array{1, 2, 3, 0}}));
  Recording upright;
  upright.has_truth = false;
  upright.spoil = [](RawScan& raw, const Vector3d&) {  // stored x, z, y, Doppler
    for (Vector3d& point : raw.points) {
      std::swap(point.y(), point.z());
    }
  };
  EXPECT_EQ(diagnosis_of(upright).of(Question::kColumns).fix, (Correction{.columns = std::array{0, 2, 1, 3}}));
}

TEST(Diagnosis, StampsThatRunFastAreFound) {
  Recording recording;
  recording.stamp_factor = 1.2;
  const Finding scale = diagnosis_of(recording).of(Question::kTimeScale);
  EXPECT_EQ(scale.verdict, Verdict::kWrong);
  EXPECT_NEAR(scale.fix.time_scale.value_or(1.0), 1.0 / 1.2, 0.03);
}

TEST(Diagnosis, ATurnedSensorIsTold) {
  Recording recording;
  const Eigen::AngleAxisd turn(0.5, Vector3d::UnitZ());
  const synthetic::Path straight = synthetic::circle(10.0, 0.0);
  recording.path = [=](double t) { return Eigen::Isometry3d(straight(t) * turn); };
  const Finding mounting = diagnosis_of(recording).of(Question::kMounting);
  EXPECT_EQ(mounting.verdict, Verdict::kSuspicious);
  EXPECT_NEAR(mounting.evidence[0].second, -0.5 * 180.0 / std::numbers::pi, 2.0);
}

TEST(Diagnosis, PointsThatCannotBeUsedAreCounted) {
  Recording recording;
  recording.spoil = [](RawScan& raw, const Vector3d&) {
    for (std::size_t i = 0; i < raw.points.size(); i += 4) {
      raw.points[i].setZero();
      raw.doppler[i + 1] = std::numeric_limits<double>::quiet_NaN();
    }
    raw.points[2].x() = 1e30;
    raw.points.resize(raw.points.size() / 4 * 4);
    raw.doppler.resize(raw.points.size());
  };
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(diagnosis.of(Question::kColumns).verdict, Verdict::kOk) << "zeros fit to any velocity, in any column";
  const Finding unusable = diagnosis.of(Question::kUnusablePoints);
  EXPECT_EQ(unusable.evidence[1].second, 0.25 * unusable.evidence[0].second);
  EXPECT_EQ(unusable.evidence[2].first, "implausible");
  EXPECT_GT(unusable.evidence[2].second, 0.0);
  EXPECT_EQ(unusable.evidence[3].second, 0.25 * unusable.evidence[0].second);
}

TEST(Diagnosis, EmptyScansAreNoReasonToFail) {
  Recording recording;
  recording.spoil = [](RawScan& raw, const Vector3d&) { raw = {raw.stamp, {}, {}, {}, {}, raw.doppler_kind, {}}; };
  const Diagnosis diagnosis = diagnosis_of(recording);
  EXPECT_EQ(diagnosis.of(Question::kUnusablePoints).verdict, Verdict::kWrong);
  EXPECT_EQ(diagnosis.of(Question::kDopplerSign).verdict, Verdict::kCannotTell);
}

}  // namespace
}  // namespace dynamic_icp::diagnosis
