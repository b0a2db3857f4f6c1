// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/scan_to_scan_icp.hpp"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

using Eigen::Vector3d;

/// A hall of 60 x 30 x 12 m of fixed points, with exact Doppler, seen by a sensor on a vehicle.
struct Hall {
  explicit Hall(std::size_t n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (std::size_t i = 0; i < n; ++i) {
      const auto axis = static_cast<Eigen::Index>(i % 3);
      Vector3d p = Vector3d(30.0 * uniform(random), 15.0 * uniform(random), 6.0 * uniform(random));
      p[axis] = ((i / 3) % 2 == 0 ? -1.0 : 1.0) * Vector3d(30.0, 15.0, 6.0)[axis];
      points.push_back(p);
    }
  }

  /// The hall from a sensor at this pose that moves straight on with this velocity (m/s, world).
  [[nodiscard]] RawScan scan(Stamp stamp, const Eigen::Isometry3d& T_world_sensor, const Vector3d& velocity) const {
    RawScan raw;
    raw.stamp = stamp;
    for (const Vector3d& point : points) {
      const Vector3d p = T_world_sensor.inverse() * point;
      raw.points.push_back(p);
      raw.doppler.push_back(-(T_world_sensor.linear() * p.normalized()).dot(velocity));
    }
    return raw;
  }

  std::vector<Vector3d> points;
};

Config dense(std::string_view method) {
  Config config = configuration(method);
  set_field(fields(config), "preprocess.voxel.voxel_size_m", "0");
  set_field(fields(config), "preprocess.range.min_range_m", "0");
  set_field(fields(config), "registration.tolerance", "1e-12");
  return config;
}

const std::array kMethods = {"point-to-point", "point-to-plane", "gicp", "doppler-icp"};

TEST(ScanToScanIcp, EveryMethodFollowsASlowDrive) {
  const Hall hall(9000);
  for (const char* method : kMethods) {
    const auto odometry = make_odometry(dense(method), {}, 2);
    for (int k = 0; k < 5; ++k) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.translation().x() = 0.05 * k;
      const Frame frame = odometry->process(hall.scan({100'000'000LL * k}, T, {0.5, 0.0, 0.0}));
      EXPECT_EQ(frame.status, k == 0 ? FrameStatus::kFirst : FrameStatus::kConverged);
      EXPECT_LT((frame.T_world_sensor.translation() - T.translation()).norm(), 1e-6) << method;
      EXPECT_EQ(frame.dynamic_candidates, 0U);
    }
  }
}

TEST(ScanToScanIcp, DopplerIcpRecoversAStraightMotionWithATurnedAndOffsetMounting) {
  const Hall hall(9000);
  Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
  T_vehicle_sensor.rotate(Eigen::AngleAxisd(0.3, Vector3d(1.0, 2.0, -1.0).normalized()));
  T_vehicle_sensor.pretranslate(Vector3d(1.4, -0.3, 1.8));
  const Vector3d velocity(20.0, 0.0, 0.0);
  const auto odometry = make_odometry(dense("doppler-icp"), {T_vehicle_sensor}, 2);
  EXPECT_TRUE(odometry->assumptions().empty());
  Eigen::Isometry3d T_first_world = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 4; ++k) {
    const Eigen::Isometry3d T_world_vehicle(Eigen::Translation3d(0.1 * k * velocity));
    const Eigen::Isometry3d T_world_sensor = T_world_vehicle * T_vehicle_sensor;
    T_first_world = k == 0 ? T_world_sensor.inverse() : T_first_world;
    const Frame frame = odometry->process(hall.scan({100'000'000LL * k}, T_world_sensor, velocity));
    const Eigen::Isometry3d expected = T_first_world * T_world_sensor;
    EXPECT_LT((frame.T_world_sensor.translation() - expected.translation()).norm(), 1e-6 * (k + 1));
    EXPECT_LT(rotation_angle(frame.T_world_sensor.linear().transpose() * expected.linear()), 1e-6 * (k + 1));
    if (k > 0) {
      EXPECT_LT((frame.ego.velocity_sensor - T_vehicle_sensor.linear().transpose() * velocity).norm(), 1e-4);
    }
  }
}

TEST(ScanToScanIcp, DopplerKernelIsMeantForTheScaledResidual) {
  // 0.2 on a residual times sqrt(0.01) is 2 m/s: Dopplers that are off by 0.5 m/s still count.
  const Hall hall(6000);
  RawScan first = hall.scan({0}, Eigen::Isometry3d::Identity(), Vector3d::Zero());
  for (double& doppler : first.doppler) {
    doppler += 0.5;
  }
  const auto odometry = make_odometry(dense("doppler-icp"), {}, 1);
  (void)odometry->process(first);
  const Frame frame = odometry->process(hall.scan({100'000'000}, Eigen::Isometry3d::Identity(), Vector3d::Zero()));
  ASSERT_GT(frame.alignment.iterations, 2);
  EXPECT_GT(frame.alignment.doppler.inliers, 5900U);
}

TEST(ScanToScanIcp, DopplerIcpSaysWhenItHasNoMounting) {
  EXPECT_EQ(ScanToScanIcp(DopplerIcpConfig{}, {}).assumptions().size(), 1U);
  EXPECT_TRUE(ScanToScanIcp(ScanToScanIcpConfig{}).assumptions().empty());
}

TEST(ScanToScanIcp, GeometryAloneDoesNotStartAtSpeedButGoesOnWithTheLastMotion) {
  const Hall hall(3000);
  const auto position_after = [&](bool constant_velocity) {
    Config config = dense("point-to-plane");
    set_field(fields(config), "registration.tolerance", "1e-7");
    std::get<ScanToScanIcpConfig>(config).constant_velocity_start = constant_velocity;
    const auto odometry = make_odometry(config, {}, 2);
    double x = 0.0;
    Frame frame;
    for (int k = 0; k < 30; ++k) {
      x += 0.03 * k;  // faster and faster, up to 8.7 m/s: 0.87 m a scan, beyond the gate of 0.3 m
      frame = odometry->process(
          hall.scan({100'000'000LL * k}, Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 0.0)), Vector3d::Zero()));
    }
    return std::abs(frame.T_world_sensor.translation().x() - x);
  };
  EXPECT_LT(position_after(true), 1e-3);
  EXPECT_GT(position_after(false), 1.0);
}

TEST(ScanToScanIcp, DeskewsByTheLastMotion) {
  const Hall hall(9000);
  Vector6d twist;
  twist << 0.0, 0.0, 0.05, 1.0, 0.2, 0.0;
  const double sweep_s = 0.1;
  // The sensor sweeps from right to left and back, so that the distortion of a scan is not that of the one before.
  const auto swept_scan = [&](int k) {
    RawScan raw;
    raw.stamp = {100'000'000LL * k};
    for (const Vector3d& point : hall.points) {
      const double share = (point.y() + 15.0) / 30.0;
      const double tau = sweep_s * (k % 2 == 0 ? share : 1.0 - share);
      raw.times.push_back(tau);
      raw.points.emplace_back(exp_se3((0.1 * k + tau) * twist).inverse() * point);
      raw.doppler.push_back(-raw.points.back().normalized().dot(twist.tail<3>()));
    }
    return raw;
  };
  const Eigen::Isometry3d T_target_source = exp_se3(-0.1 * twist);
  for (const char* method : kMethods) {
    const auto rotation_error_at_the_end = [&](bool deskew) {
      Config config = dense(method);
      set_field(fields(config), "icp.constant_velocity_start", "true");
      set_field(fields(config), "icp.deskew", deskew ? "true" : "false");
      const auto odometry = make_odometry(config, {}, 2);
      Frame frame;
      for (int k = 0; k < 12; ++k) {
        frame = odometry->process(swept_scan(k));
        EXPECT_EQ(frame.sweep.has_value(), deskew) << "untouched unless asked for";
      }
      EXPECT_EQ(frame.status, FrameStatus::kConverged);
      return rotation_angle(frame.T_target_source.linear().transpose() * T_target_source.linear());
    };
    EXPECT_LT(rotation_error_at_the_end(true), 1e-4) << method;
    EXPECT_GT(rotation_error_at_the_end(false), 1e-3) << method;
  }
}

TEST(ScanToScanIcp, PosesOfDeskewedScansAreThoseAtTheStamps) {
  const Hall hall(9000);
  const double acceleration = 1.0;  // m/s^2, along x; from the middle of a scan to that of the next 5 mm more than here
  const auto x = [&](double t) { return 0.5 * t + 0.5 * acceleration * t * t; };
  Config config = dense("point-to-plane");
  set_field(fields(config), "icp.constant_velocity_start", "true");
  set_field(fields(config), "icp.deskew", "true");
  const auto odometry = make_odometry(config, {}, 2);
  Frame frame;
  for (int k = 0; k < 12; ++k) {
    RawScan raw;
    raw.stamp = {100'000'000LL * k};
    for (const Vector3d& point : hall.points) {
      raw.times.push_back(0.1 * (point.y() + 15.0) / 30.0);
      raw.points.emplace_back(point - Vector3d(x(0.1 * k + raw.times.back()), 0.0, 0.0));
      raw.doppler.push_back(0.0);
    }
    frame = odometry->process(raw);
  }
  EXPECT_NEAR(-frame.T_target_source.translation().x(), x(1.1) - x(1.0), 1e-3);
}

TEST(ScanToScanIcp, SameBitsForAnyNumberOfThreads) {
  const Hall hall(6000);
  for (const char* method : kMethods) {
    std::vector<Eigen::Matrix4d> expected;
    for (const int threads : {1, 2, 7}) {
      const auto odometry = make_odometry(configuration(method), {}, threads);
      std::vector<Eigen::Matrix4d> poses;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Isometry3d T(Eigen::Translation3d(0.1 * k, 0.02 * k, 0.0));
        poses.push_back(odometry->process(hall.scan({100'000'000LL * k}, T, {1.0, 0.2, 0.0})).T_world_sensor.matrix());
      }
      expected = expected.empty() ? poses : expected;
      EXPECT_EQ(poses, expected);
    }
  }
}

TEST(ScanToScanIcp, EmptyScansAreBridgedAndOldOnesRefused) {
  const Hall hall(3000);
  const auto odometry = make_odometry(dense("gicp"), {}, 1);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  EXPECT_EQ(odometry->process(RawScan{}).status, FrameStatus::kTooFewPoints);
  EXPECT_EQ(odometry->process(hall.scan({1}, here, Vector3d::Zero())).status, FrameStatus::kFirst);
  RawScan empty;
  empty.stamp = {100'000'000};
  EXPECT_EQ(odometry->process(empty).status, FrameStatus::kTooFewPoints);
  EXPECT_EQ(odometry->process(hall.scan({200'000'000}, here, Vector3d::Zero())).status, FrameStatus::kConverged);
  EXPECT_EQ(odometry->process(hall.scan({5'000'000'000}, here, Vector3d::Zero())).status, FrameStatus::kTimeGap);
  EXPECT_THROW((void)odometry->process(hall.scan({200'000'000}, here, Vector3d::Zero())), DataError);
}

TEST(Methods, AreMadeByName) {
  for (const std::string_view name : method_names()) {
    EXPECT_NE(make_odometry(configuration(name), {}, 1), nullptr) << name;
  }
  EXPECT_THROW((void)configuration("magic"), UsageError);
  EXPECT_THROW((void)configuration("dynamic-icp", "best"), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::odometry
