// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// What goes on from a saved state gives the bits of what was never interrupted.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

#include "testing/synthetic_drive.hpp"
#include "testing/synthetic_rig.hpp"

namespace dynamic_icp::odometry {
namespace {

using namespace synthetic;

/// All that a frame says but times of computation, as bytes. A copy, for an archive might write to what it is given.
std::string bytes_of(Frame frame) {
  StateArchive all;
  registration::Alignment& alignment = frame.alignment;
  all(frame.status, frame.stamp, frame.T_world_sensor, frame.T_target_source, alignment.status,
      alignment.T_target_source, alignment.iterations, alignment.fitness, alignment.inlier_rmse,
      alignment.correspondences, alignment.length_m, alignment.information_ratio, alignment.covariance);
  all.each(alignment.degenerate, [&](estimation::DegenerateDirection& one) { all(one.direction); });
  ego_motion::EgoVelocity& ego = frame.ego;
  all(ego.status, ego.velocity_sensor, ego.covariance, ego.unobservable, ego.iterations, ego.points, ego.inliers,
      ego.inlier_rms_mps, ego.acceleration_sensor, ego.reference_time_s, ego.bias_mps, ego.bias_variance,
      ego.joint_covariance);
  if (ego.rotation) {
    all(ego.rotation->omega, ego.rotation->covariance);
  }
  if (frame.twist) {
    all(frame.twist->angular, frame.twist->linear, frame.twist->covariance);
  }
  all.each(frame.clusters, [&](dynamics::ObjectEstimate& one) {
    all(one.verdict, one.velocity_sensor, one.covariance, one.members, one.centroid, one.extent);
  });
  all.each(frame.tracked, [&](tracking::TrackedObject& one) {
    all(one.id, one.divided_from, one.status, one.velocity_sensor, one.covariance, one.yaw_rate_rps,
        one.yaw_rate_variance, one.tangential_observed, one.centroid, one.extent, one.box.centre, one.box.axes,
        one.box.size, one.centre_covariance, one.faces, one.prediction.centre, one.prediction.centre_covariance,
        one.prediction.velocity_sensor, one.age_scans, one.scans_seen, one.members);
  });
  all(frame.dynamic_candidates, frame.dynamic_clustered, frame.dynamic_refined, frame.points, frame.points_used,
      frame.static_points, frame.labels);
  return all.take();
}

std::string bytes_of(const window::SensorCalibration& calibration) {
  StateArchive all;
  window::SensorCalibration copy = calibration;
  all.each(copy.parts, [&](window::SensorCalibration::Part& part) {
    all(part.name, part.scale_mps, part.error_mps, part.sigma_mps);
  });
  all(copy.information, copy.gradient, copy.stamp_sigma_s, copy.period_sigma_s, copy.scan_error_mps);
  return all.take();
}

/// Interrupts after each number of scans in `at`, and goes on with another number of threads.
void expect_same_bits(const Config& config, const std::vector<RawScan>& scans, const std::vector<std::size_t>& at,
                      const SensorContext& context = {}) {
  const auto unbroken = make_odometry(config, context, 1);
  std::vector<std::string> states = {unbroken->save()};
  std::vector<std::string> frames;
  for (const RawScan& scan : scans) {
    frames.push_back(bytes_of(unbroken->process(scan)));
    states.push_back(unbroken->save());
  }
  const auto used = make_odometry(config, context, 2);  // for one state after another: nothing of the last one stays
  for (const std::size_t interrupted : at) {
    const auto other = make_odometry(config, context, 2);
    other->load(states[interrupted]);
    EXPECT_TRUE(other->save() == states[interrupted]) << interrupted;
    used->load(states[interrupted]);
    for (std::size_t k = interrupted; k < scans.size(); ++k) {
      ASSERT_TRUE(bytes_of(other->process(scans[k])) == frames[k])
          << "interrupted at " << interrupted << ", scan " << k;
      ASSERT_TRUE(bytes_of(used->process(scans[k])) == frames[k]) << "interrupted at " << interrupted << ", scan " << k;
    }
    EXPECT_TRUE(other->save() == states.back()) << interrupted;
    ASSERT_EQ(other->calibration().has_value(), unbroken->calibration().has_value());
    if (const auto calibration = other->calibration()) {
      EXPECT_TRUE(bytes_of(*calibration) == bytes_of(unbroken->calibration().value())) << interrupted;
    }
  }
}

std::vector<RawScan> scans_of(const Drive& drive, int scans) {
  std::vector<RawScan> result;
  for (int k = 0; k < scans; ++k) {
    result.push_back(drive.scan(k));
  }
  return result;
}

/// Cars, a sweep, an error of the Doppler, a motion that changes.
Drive everything() {
  Drive drive{street_with_cars(), agile(10.0), sweeping()};
  drive.sensor.bias_mps = 0.1;
  drive.sensor.columns = 160;
  drive.sensor.rows = 24;
  return drive;
}

TEST(SavedState, PresetDefaultGoesOnWithTheSameBits) {
  const std::vector<RawScan> scans = scans_of(everything(), 24);
  const auto whole = make_odometry({}, {}, 1);
  std::size_t tracked = 0;
  for (const RawScan& scan : scans) {
    tracked += whole->process(scan).tracked.size();
  }
  ASSERT_GT(tracked, 20u) << "objects are part of it";
  ASSERT_TRUE(whole->calibration().has_value()) << "and so is what was learned of the sensor";
  expect_same_bits({}, scans, {0, 1, 2, 3, 5, 8, 16, 24});
}

TEST(SavedState, AllPipelinesGoOnWithTheSameBits) {
  const std::vector<RawScan> scans = scans_of(everything(), 7);
  for (const Pipeline& pipeline : pipelines()) {
    SCOPED_TRACE(std::string(pipeline.method) + " " + std::string(pipeline.preset));
    expect_same_bits(pipeline.config, scans, {0, 1, 4});
  }
}

TEST(SavedState, WhatIsNoPartOfTheDefaultGoesOnToo) {
  const std::vector<RawScan> scans = scans_of(everything(), 7);
  for (const char* const ablation : {"no-vf", "no-dpp", "no-dr", "no-bias", "no-deskew", "no-map", "no-vibration"}) {
    SCOPED_TRACE(ablation);
    expect_same_bits(with_ablation(ablation), scans, {1, 4});
  }
}

TEST(SavedState, ScansThatAreNoUseAndThatWereLost) {
  Drive elsewhere = everything();
  elsewhere.path = [](double t) {
    Eigen::Isometry3d T_world_here = Eigen::Isometry3d::Identity();
    T_world_here.linear() = exp_so3(Vector3d(0.0, 0.0, 0.7));
    T_world_here.translation() = Vector3d(63.0, -3.0, 4.0);
    return Eigen::Isometry3d(T_world_here * agile(10.0)(t));
  };
  std::vector<RawScan> scans = scans_of(everything(), 6);
  scans[3] = {};  // no points
  scans[3].stamp = everything().scan(3).stamp;
  for (int k = 6; k < 9; ++k) {
    scans.push_back(elsewhere.scan(k));
  }
  for (int k = 59; k < 62; ++k) {  // after a gap
    scans.push_back(elsewhere.scan(k));
  }
  const auto odometry = make_odometry({}, {}, 1);
  std::vector<FrameStatus> statuses;
  for (const RawScan& scan : scans) {
    statuses.push_back(odometry->process(scan).status);
  }
  ASSERT_EQ(statuses[3], FrameStatus::kTooFewPoints);
  ASSERT_EQ(statuses[6], FrameStatus::kLost);
  ASSERT_EQ(statuses[9], FrameStatus::kTimeGap);
  for (const Pipeline& pipeline : pipelines()) {
    SCOPED_TRACE(std::string(pipeline.method) + " " + std::string(pipeline.preset));
    expect_same_bits(pipeline.config, scans, {4, 7, 9});
  }
}

// Two motions explained the first scan; a plain does not show how the first scans turned.
TEST(SavedState, WhatIsInDoubtFromScanToScan) {
  std::vector<RawScan> divided = scans_of({street(), circle(8.0, 0.0), {}}, 7);
  for (std::size_t i = 0; i < divided[0].points.size(); ++i) {
    const Vector3d u = divided[0].points[i].normalized();
    divided[0].doppler[i] += u.y() > 0.0 ? 2.0 * u.x() : 0.0;
  }
  std::vector<RawScan> bent = scans_of({plain(), circle(8.0, 0.5), sweeping()}, 2);
  for (int k = 2; k < 6; ++k) {
    bent.push_back(Drive{street(), circle(8.0, 0.5), sweeping()}.scan(k));
  }
  const auto odometry = make_odometry({}, {}, 1);
  odometry->process(divided[0]);
  ASSERT_EQ(odometry->process(divided[1]).status, FrameStatus::kAmbiguous);
  const auto other = make_odometry({}, {}, 1);
  other->process(bent[0]);
  ASSERT_EQ(other->process(bent[1]).status, FrameStatus::kDegenerate);
  expect_same_bits({}, divided, {1, 3});
  expect_same_bits({}, bent, {2, 3});
}

TEST(SavedState, Rigs) {
  std::vector<RawScan> scans;
  const Drive drive = everything();
  for (int k = 0; k < 8; ++k) {
    scans.push_back(
        rig_scan(drive.world, drive.path, drive.sensor, kFrontPair, {0.1, -0.1}, k * drive.period_s, drive.seed));
    if (k >= 3) {
      scans.back().mountings.clear();  // those of the scan before hold on
    }
  }
  expect_same_bits({}, scans, {1, 3, 5});
}

TEST(SavedState, CompensatedDoppler) {
  const Drive drive = everything();
  std::vector<RawScan> scans = scans_of(drive, 7);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    RawScan& scan = scans[k];
    scan.doppler_kind = DopplerKind::kCompensated;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const double time_s = static_cast<double>(k) * drive.period_s + scan.times[i];
      scan.doppler[i] += scan.points[i].normalized().dot(velocity_sensor(drive.path, time_s));
    }
  }
  SensorContext context;
  context.doppler_kind = DopplerKind::kCompensated;
  PaperConfig published;
  published.published_compensated = true;
  for (const Config& config : {Config{}, Config{PaperConfig{}}, Config{published}}) {
    expect_same_bits(config, scans, {1, 2, 4}, context);
  }
}

TEST(SavedState, ACalibrationIsPartOfIt) {
  const std::vector<RawScan> scans = scans_of(everything(), 9);
  const auto teacher = make_odometry({}, {}, 1);
  for (const RawScan& scan : scans) {
    teacher->process(scan);
  }
  SensorContext context;
  context.calibration = teacher->calibration();
  expect_same_bits({}, scans, {0, 1, 3}, context);
}

std::string refusal_of(Odometry& odometry, std::string_view state) {
  try {
    odometry.load(state);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(SavedState, OfAnotherConfigurationIsRefusedByName) {
  const auto odometry = make_odometry({}, {}, 1);
  odometry->process(everything().scan(0));
  const std::string state = odometry->save();
  WindowOdometryConfig config;
  config.window.knot_spacing_s = 0.02;
  EXPECT_EQ(refusal_of(*make_odometry(config, {}, 1), state),
            "the state was saved with window.knot_spacing_s 0.0125, this is 0.02");
  EXPECT_NE(refusal_of(*make_odometry(PaperConfig{}, {}, 1), state), "");
  for (const char* const method : {"point-to-point", "point-to-plane", "gicp", "kiss-icp", "doppler-icp"}) {
    const std::string other = make_odometry(configuration(method), {}, 1)->save();
    for (const char* const loaded : {"point-to-point", "point-to-plane", "gicp", "kiss-icp", "doppler-icp"}) {
      EXPECT_EQ(refusal_of(*make_odometry(configuration(loaded), {}, 1), other).empty(),
                std::string_view(method) == loaded)
          << method << " " << loaded;
    }
  }
}

TEST(SavedState, DamagedIsRefused) {
  const auto odometry = make_odometry({}, {}, 1);
  odometry->process(everything().scan(0));
  const std::string state = odometry->save();
  const auto other = make_odometry({}, {}, 1);
  for (std::size_t at = 0; at < state.size(); at += state.size() / 50) {
    std::string damaged = state;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    EXPECT_NE(refusal_of(*other, damaged), "") << at;
    EXPECT_NE(refusal_of(*other, std::string_view(state).substr(0, at)), "") << at;
  }
  EXPECT_EQ(refusal_of(*other, state), "");
}

}  // namespace
}  // namespace dynamic_icp::odometry
