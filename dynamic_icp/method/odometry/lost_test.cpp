// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/synthetic_drive.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

TEST(WindowOdometryLost, LosesItsWayAndFindsItAgain) {
  const Drive here{street(), circle(10.0, 0.2), {}};
  Drive elsewhere = here;
  elsewhere.path = [&here](double t) {
    Eigen::Isometry3d T_world_here = Eigen::Isometry3d::Identity();
    T_world_here.linear() = exp_so3(Vector3d(0.0, 0.0, 0.7));
    T_world_here.translation() = Vector3d(63.0, -3.0, 4.0);
    return Eigen::Isometry3d(T_world_here * here.path(t));
  };
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (int k = 0; k < 5; ++k) {
    odometry->process(here.scan(k));
  }
  const Frame lost = odometry->process(elsewhere.scan(5));
  EXPECT_EQ(lost.status, FrameStatus::kLost);
  EXPECT_EQ(verdict(lost.status), "lost");
  EXPECT_LT(error_of(here, lost, 4, 5).move_m, 0.02) << "the motion that was expected";
  EXPECT_LT(error_of(here, lost, 4, 5).turn_deg, 0.5);
  ASSERT_TRUE(lost.alignment.covariance.has_value());
  for (int k = 6; k < 9; ++k) {
    const Frame found = odometry->process(elsewhere.scan(k));
    EXPECT_EQ(verdict(found.status), "ok") << k;
    EXPECT_LT(error_of(elsewhere, found, k - 1, k).move_m, 0.005) << k;
    EXPECT_LT(error_of(elsewhere, found, k - 1, k).turn_deg, 0.08) << k;
  }
}

// Planes and Doppler may contradict each other by what sensors err, not by more.
TEST(WindowOdometryLost, IsLostWhenTheDopplerContradictsTheMap) {
  const Drive drive{street(), circle(8.0, 0.0), {}};
  for (const double off_mps : {0.3, 3.0}) {
    const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
    for (int k = 0; k <= 6; ++k) {
      RawScan scan = drive.scan(k);
      for (std::size_t i = 0; i < scan.points.size() && k == 6; ++i) {
        scan.doppler[i] -= off_mps * scan.points[i].normalized().x();
      }
      const Frame frame = odometry->process(scan);
      if (k == 6) {
        EXPECT_EQ(verdict(frame.status), off_mps > 1.0 ? "lost" : "ok") << off_mps;
      }
    }
  }
}

// There is no usual share of points that fit yet.
TEST(WindowOdometryLost, IsLostWhenTheSecondScanFitsNothing) {
  const Drive here{street(), circle(10.0, 0.2), {}};
  const Drive elsewhere{tunnel(),
                        [](double t) {
                          Eigen::Isometry3d T = circle(10.0, 0.2)(t);
                          T.linear() = T.linear() * exp_so3(Vector3d(0.0, 0.5, 0.5));
                          return T;
                        },
                        {}};
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  odometry->process(here.scan(0));
  EXPECT_EQ(odometry->process(elsewhere.scan(1)).status, FrameStatus::kLost);
  const Frame found = odometry->process(elsewhere.scan(2));
  EXPECT_NE(found.status, FrameStatus::kLost);
  // Walls that hold the way along a tunnel and the turn around it but badly may say so.
  const Vector6d left = error_of(elsewhere, found, 1, 2).left;
  ASSERT_TRUE(found.alignment.covariance.has_value());
  EXPECT_LT(left.dot(found.alignment.covariance->ldlt().solve(left)), 22.5) << "0.999 of chi-squared with 6";
}

// Velocities that are nearly or exactly simultaneous say nothing of the acceleration.
TEST(WindowOdometryLost, TakesScansThatAreAlmostSimultaneous) {
  const Drive drive{street(), circle(10.0, 0.2), {}};
  for (const double gap_s : {1e-9, 1e-6, 1e-3}) {
    const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
    odometry->process(drive.scan(0));
    odometry->process(scan_at(drive.world, drive.path, drive.sensor, gap_s).raw);
    const Frame frame = odometry->process(drive.scan(1));
    EXPECT_EQ(verdict(frame.status), "ok") << gap_s;
    EXPECT_LT((frame.T_world_sensor.translation() - Vector3d(1.0, 0.01, 0.0)).norm(), 0.005) << gap_s;
  }
}

TEST(WindowOdometryLost, TakesScansWhoseMiddlesCoincide) {
  const Drive drive{street(), circle(0.0, 0.0), {}};
  RawScan swept = drive.scan(0);
  for (std::size_t i = 0; i < swept.points.size(); ++i) {
    swept.times.push_back(i % 2 == 0 ? 0.0 : 0.2);
  }
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  odometry->process(swept);
  for (const int k : {1, 2}) {
    const Frame frame = odometry->process(drive.scan(k));
    EXPECT_LT(frame.T_world_sensor.translation().norm(), 0.05) << k;
  }
}

RawScan empty_scan(double time_s) {
  RawScan raw;
  raw.stamp = stamp_at(time_s);
  return raw;
}

TEST(WindowOdometryLost, BridgesAnEmptyScan) {
  const Drive drive{street(), circle(10.0, 0.2), {}};
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  EXPECT_EQ(odometry->process(empty_scan(-0.1)).status, FrameStatus::kTooFewPoints);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(odometry->process(drive.scan(k)).status, k == 0 ? FrameStatus::kFirst : FrameStatus::kConverged);
  }
  const Frame empty = odometry->process(empty_scan(0.4));
  EXPECT_EQ(empty.status, FrameStatus::kTooFewPoints);
  EXPECT_LT(error_of(drive, empty, 3, 4).move_m, 0.02);
  EXPECT_LT(nis(error_of(drive, empty, 3, 4).left, *empty.alignment.covariance), 20.0);
  const Frame next = odometry->process(drive.scan(5));
  EXPECT_EQ(verdict(next.status), "ok");
  EXPECT_LT(error_of(drive, next, 3, 5).move_m, 0.003) << "aligned over both steps";
  EXPECT_LT(error_of(drive, next, 3, 5).turn_deg, 0.03);
}

TEST(WindowOdometryLost, BeginsANewMapAfterAGap) {
  const Drive drive{street(), circle(10.0, 0.0), {}};
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (const int k : {0, 1, 2}) {
    odometry->process(drive.scan(k));
  }
  const Frame late = odometry->process(drive.scan(22));
  EXPECT_EQ(late.status, FrameStatus::kTimeGap);
  EXPECT_EQ(verdict(late.status), "lost");
  EXPECT_LT(error_of(drive, late, 2, 22).move_m, 0.2) << "two seconds at the velocity before the gap";
  const Frame next = odometry->process(drive.scan(23));
  EXPECT_EQ(next.status, FrameStatus::kConverged);
  EXPECT_LT(error_of(drive, next, 22, 23).move_m, 0.003);
}

TEST(WindowOdometryLost, KeepsItsStateWhenItRefusesAScan) {
  const Drive drive{street_with_cars(), agile(10.0), {}};
  const auto disturbed = make_odometry(WindowOdometryConfig{}, {}, 1);
  const auto calm = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (int k = 1; k < 5; ++k) {
    EXPECT_TRUE(same_bits(disturbed->process(drive.scan(k)), calm->process(drive.scan(k)))) << k;
    EXPECT_THROW(disturbed->process(drive.scan(k)), DataError);
    EXPECT_THROW(disturbed->process(drive.scan(0)), DataError);
  }
}

TEST(WindowOdometryLost, LeavesOutPointsThatAreNoNumbers) {
  const Drive drive{street(), circle(10.0, 0.2), {}};
  const auto disturbed = make_odometry(WindowOdometryConfig{}, {}, 1);
  const auto calm = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (int k = 0; k < 3; ++k) {
    RawScan raw = drive.scan(k);
    const Frame expected = calm->process(raw);
    raw.points.insert(raw.points.end(), {{NAN, 1.0, 1.0}, {9.0, 1.0, 0.5}, {0.0, 0.0, 0.0}, {5e3, 0.0, 0.0}});
    raw.doppler.insert(raw.doppler.end(), {1.0, NAN, 1.0, -10.0});
    const Frame frame = disturbed->process(raw);
    EXPECT_EQ(frame.T_world_sensor.matrix(), expected.T_world_sensor.matrix());
    EXPECT_EQ(frame.dropped.non_finite, 2u);
    ASSERT_EQ(frame.labels.size(), expected.labels.size() + 4);
    EXPECT_TRUE(std::all_of(frame.labels.end() - 4, frame.labels.end(), [](auto label) { return label == -1; }));
  }
}

TEST(WindowOdometryLost, RefusesConfigurationsOutOfRange) {
  WindowOdometryConfig config = WindowOdometryConfig{};
  config.window.max_iterations = 0;
  EXPECT_THROW(make_odometry(config, {}, 1), UsageError);
}

/// Lorries creep on both sides. Their Doppler is that of what stands, up to a scan.
class CreepingLorries {
 public:
  explicit CreepingLorries(int noticed) : noticed_(noticed) {
    drive_.world.cars = {{{1.0, 2.0, 0.3}, {26.0, 4.5, 4.0}, velocity_},
                         {{6.0, -5.0, 0.3}, {16.0, -2.5, 4.0}, velocity_}};
  }

  [[nodiscard]] const Drive& drive() const { return drive_; }

  [[nodiscard]] RawScan scan(int k) const {
    auto [raw, car] = scan_at(drive_.world, drive_.path, drive_.sensor, k * drive_.period_s);
    for (std::size_t i = 0; i < car.size() && k < noticed_; ++i) {
      raw.doppler[i] -= car[i] >= 0 ? raw.points[i].normalized().dot(velocity_) : 0.0;
    }
    return raw;
  }

 private:
  Vector3d velocity_{1.5, 0.0, 0.0};  // along the path
  Drive drive_{street(), circle(3.0, 0.0), {}};
  int noticed_;
};

double known_of_sensor(const Odometry& odometry) {
  const window::SensorCalibration calibration = odometry.calibration().value();
  double trace = 0.0;
  for (std::size_t k = 0; k < calibration.information.size(); ++k) {
    trace += calibration.information[k][k];
  }
  return trace;
}

TEST(WindowOdometryLost, BeginsAnewWhenWhatItTookForStaticInTheFirstScansMoves) {
  constexpr int kNoticed = 4;
  const CreepingLorries lorries(kNoticed);
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  double known_before = 0.0;
  for (int k = 0; k < 20; ++k) {
    const Frame frame = odometry->process(lorries.scan(k));
    EXPECT_EQ(frame.status == FrameStatus::kLost, k == kNoticed) << k;
    const double known = known_of_sensor(*odometry);
    if (k == kNoticed) {
      EXPECT_LT(known, known_before) << "what was learned of the sensor is forgotten";
    } else if (k > kNoticed + 2) {
      EXPECT_LT(error_of(lorries.drive(), frame, k - 1, k).move_m, 0.01) << k;
    }
    known_before = known;
  }
}

TEST(WindowOdometryLost, GoesOnWhenWhatStoodForLongMoves) {
  constexpr int kNoticed = 15;
  const CreepingLorries lorries(kNoticed);
  const auto odometry = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (int k = 0; k <= kNoticed; ++k) {
    EXPECT_NE(odometry->process(lorries.scan(k)).status, FrameStatus::kLost) << k;
  }
}

TEST(WindowOdometryLost, GoesOnWithAKnownSensorWhenWhatStoodMoves) {
  constexpr int kNoticed = 4;
  const CreepingLorries lorries(kNoticed);
  const auto before = make_odometry(WindowOdometryConfig{}, {}, 1);
  for (int k = 0; k < 3; ++k) {
    before->process(lorries.scan(k));
  }
  SensorContext context;
  context.calibration = before->calibration();
  const auto odometry = make_odometry(WindowOdometryConfig{}, context, 1);
  for (int k = 0; k <= kNoticed; ++k) {
    EXPECT_NE(odometry->process(lorries.scan(k)).status, FrameStatus::kLost) << k;
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
