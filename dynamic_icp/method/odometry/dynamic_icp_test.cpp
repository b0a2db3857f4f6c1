// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/dynamic_icp.hpp"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kPeriodNs = 100'000'000;

struct Car {
  double x = 0.0;  // m, rear at t = 0
  double y = 0.0;  // m, right side
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

/// A street with ground, house fronts and recesses, and two cars: HDBSCAN without a root cluster finds none in a scene
/// with a single one. The sensor is 1.5 m above ground at x = speed * t and looks along x without turning; each scan
/// samples other points of the surfaces.
struct Street {
  double speed = 5.0;           // m/s
  double doppler_noise = 0.02;  // m/s
  std::size_t car_points = 200;
  std::vector<Car> cars = {{12.0, -3.0, {9.0, 0.0, 0.0}}, {28.0, 2.0, {-8.0, 0.0, 0.0}}};

  [[nodiscard]] RawScan scan(int k) const {
    std::mt19937 random(static_cast<unsigned>(1000 + k));
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> normal;
    const double t = 0.1 * k;
    RawScan raw;
    raw.stamp = Stamp{k * kPeriodNs};
    const auto add = [&](const Vector3d& p_world, const Vector3d& v_world) {
      const Vector3d p = p_world - Vector3d(speed * t, 0.0, 0.0);
      raw.points.push_back(p);
      raw.doppler.push_back(p.normalized().dot(v_world - Vector3d(speed, 0.0, 0.0)) + doppler_noise * normal(random));
    };
    for (int i = 0; i < 3000; ++i) {
      add({speed * t + 40.0 * uniform(random), 12.0 * uniform(random) - 6.0, -1.5}, Vector3d::Zero());
      const double x = speed * t + 40.0 * uniform(random);
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      const bool recess = std::fmod(x, 8.0) < 3.0;
      add({x, side * (recess ? 7.5 : 6.0), 4.0 * uniform(random) - 1.5}, Vector3d::Zero());
      // The cheeks of the recesses face along the street.
      const double cheek = 8.0 * std::floor(x / 8.0) + (i % 4 < 2 ? 0.0 : 3.0);
      add({cheek, side * (6.0 + 1.5 * uniform(random)), 4.0 * uniform(random) - 1.5}, Vector3d::Zero());
    }
    for (const Car& car : cars) {
      for (std::size_t i = 0; i < car_points; ++i) {
        const bool end = i % 2 == 0;
        add(Vector3d(car.x, car.y, -1.2) + car.velocity * t +
                Vector3d(end ? 0.0 : 4.0 * uniform(random), end ? 1.8 * uniform(random) : 0.9, 1.4 * uniform(random)),
            car.velocity);
      }
    }
    return raw;
  }
};

RawScan empty_scan(int k) {
  RawScan raw;
  raw.stamp = Stamp{k * kPeriodNs};
  return raw;
}

double position_error(const Frame& frame, double x) {
  return (frame.T_world_sensor.translation() - Vector3d(x, 0.0, 0.0)).norm();
}

/// Converged, or still exchanging a correspondence or two when the last iteration came: the pose is as good.
bool is_aligned(const Frame& frame) {
  return frame.status == FrameStatus::kConverged || frame.status == FrameStatus::kIterationLimit;
}

TEST(DynamicIcp, FollowsAStraightDrive) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 2);
  const Frame first = odometry.process(street.scan(0));
  EXPECT_EQ(first.status, FrameStatus::kFirst);
  EXPECT_TRUE(first.T_world_sensor.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(first.alignment.status, registration::AlignStatus::kNotRun);
  for (int k = 1; k <= 6; ++k) {
    const Frame frame = odometry.process(street.scan(k));
    EXPECT_TRUE(is_aligned(frame)) << k << " " << to_string(frame.status);
    EXPECT_LT(position_error(frame, 0.5 * k), 0.05) << k;
    EXPECT_LT((frame.ego.velocity_sensor - Vector3d(5.0, 0.0, 0.0)).norm(), 0.1) << k;
    EXPECT_LT(rotation_angle(frame.T_world_sensor.linear()), 0.01);
  }
}

TEST(DynamicIcp, FindsTheMovingCars) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 1);
  const Frame frame = odometry.process(street.scan(0));
  EXPECT_GT(frame.dynamic_candidates, 60u);
  EXPECT_GE(frame.dynamic_candidates, frame.dynamic_clustered);
  EXPECT_GE(frame.dynamic_clustered, frame.dynamic_refined);
  std::size_t found = 0;
  for (const Car& car : street.cars) {
    for (const dynamics::ObjectEstimate& cluster : frame.clusters) {
      const double offset = std::abs(cluster.centroid.x() - car.x - 2.0);
      if (cluster.verdict == dynamics::ClusterVerdict::kAccepted && offset < 3.0) {
        EXPECT_NEAR(cluster.velocity_sensor.x(), car.velocity.x(), 0.5);
        ++found;
      }
    }
  }
  EXPECT_EQ(found, 2u);
}

TEST(DynamicIcp, LabelsEveryPointAsRead) {
  const Street street;
  RawScan raw = street.scan(0);
  raw.points[0] = {NAN, 0.0, 0.0};
  raw.points[1] = {5000.0, 0.0, 0.0};
  DynamicIcp odometry(PaperConfig{}, 1);
  const Frame frame = odometry.process(raw);
  ASSERT_EQ(frame.labels.size(), raw.points.size());
  EXPECT_EQ(frame.labels[0], -1);
  EXPECT_EQ(frame.labels[1], -1);
  EXPECT_EQ(frame.dropped.non_finite, 1u);
  EXPECT_EQ(frame.dropped.out_of_range, 1u);
  std::size_t in_object = 0;
  std::size_t is_static = 0;
  for (std::size_t i = 0; i < frame.labels.size(); ++i) {
    in_object += frame.labels[i] > 0 ? 1 : 0;
    is_static += frame.labels[i] == 0 ? 1 : 0;
    if (frame.labels[i] > 0) {
      EXPECT_GE(i, 9000u) << "the points of the cars are the last of the scan";
    }
  }
  EXPECT_EQ(in_object, frame.dynamic_refined);
  EXPECT_EQ(is_static, frame.points_used - frame.dynamic_candidates);
}

TEST(DynamicIcp, RecoversAfterAnEmptyScan) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 1);
  odometry.process(street.scan(0));
  odometry.process(street.scan(1));
  const Frame lost = odometry.process(empty_scan(2));
  EXPECT_EQ(lost.status, FrameStatus::kTooFewPoints);
  EXPECT_LT(position_error(lost, 1.0), 0.05) << "the predicted motion is kept";
  const Frame found = odometry.process(street.scan(3));
  EXPECT_TRUE(is_aligned(found)) << "aligned to scan 1";
  EXPECT_LT(position_error(found, 1.5), 0.05);
}

TEST(DynamicIcp, RecoversAfterAScanThatDoesNotFit) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 1);
  odometry.process(street.scan(0));
  odometry.process(street.scan(1));
  RawScan elsewhere = empty_scan(2);  // a few points far from everything, seen with the right Doppler
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    elsewhere.points.emplace_back(100.0 + 50.0 * uniform(random), 100.0 * uniform(random),
                                  20.0 + 15.0 * uniform(random));
    elsewhere.doppler.push_back(-5.0 * elsewhere.points.back().normalized().x());
  }
  const Frame lost = odometry.process(elsewhere);
  EXPECT_EQ(lost.status, FrameStatus::kTooFewCorrespondences);
  EXPECT_LT(position_error(lost, 1.0), 0.05);
  const Frame next = odometry.process(street.scan(3));
  EXPECT_LT(position_error(next, 1.5), 0.1);
  EXPECT_TRUE(is_aligned(odometry.process(street.scan(4))));
}

TEST(DynamicIcp, RecoversAfterATimeGap) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 1);
  odometry.process(street.scan(0));
  odometry.process(street.scan(1));
  const Frame late = odometry.process(street.scan(31));
  EXPECT_EQ(late.status, FrameStatus::kTimeGap);
  EXPECT_LT(position_error(late, 15.5), 0.5) << "three seconds at the velocity before the gap";
  const Frame next = odometry.process(street.scan(32));
  EXPECT_TRUE(is_aligned(next));
  EXPECT_LT((next.T_world_sensor.translation() - late.T_world_sensor.translation() - Vector3d(0.5, 0, 0)).norm(), 0.05);
}

TEST(DynamicIcp, RefusesTimeThatStandsStillOrRunsBackwards) {
  const Street street;
  DynamicIcp odometry(PaperConfig{}, 1);
  odometry.process(street.scan(3));
  EXPECT_THROW(odometry.process(street.scan(3)), DataError);
  EXPECT_THROW(odometry.process(street.scan(1)), DataError);
  EXPECT_TRUE(is_aligned(odometry.process(street.scan(4)))) << "the state is unchanged";
}

TEST(DynamicIcp, DegenerateScansHaveAStatusAndFinitePoses) {
  RawScan one = empty_scan(0);
  one.points = {{1, 2, 3}};
  one.doppler = {0.5};
  RawScan same_voxel = empty_scan(1);
  same_voxel.points.assign(500, Vector3d(5.05, 5.05, 5.05));
  same_voxel.doppler.assign(500, 1.0);
  RawScan no_doppler = Street{}.scan(2);
  no_doppler.doppler.assign(no_doppler.points.size(), 0.0);
  RawScan all_wild = Street{}.scan(3);  // nothing agrees with anything
  for (std::size_t i = 0; i < all_wild.doppler.size(); ++i) {
    all_wild.doppler[i] = i % 2 == 0 ? 40.0 : -40.0;
  }
  RawScan not_a_number = Street{}.scan(4);
  not_a_number.doppler.assign(not_a_number.points.size(), std::nan(""));
  DynamicIcp odometry(PaperConfig{}, 1);
  for (const RawScan& raw : {one, same_voxel, no_doppler, all_wild, not_a_number}) {
    const Frame frame = odometry.process(raw);
    EXPECT_NE(frame.status, FrameStatus::kNotRun);
    EXPECT_TRUE(frame.T_world_sensor.matrix().allFinite());
    EXPECT_TRUE(frame.ego.velocity_sensor.allFinite());
  }
}

TEST(DynamicIcp, AblationsDoWhatTheirNamesSay) {
  const Street street;
  PaperConfig config;
  apply_ablation(config, "no-vf");
  EXPECT_EQ(DynamicIcp(config, 1).process(street.scan(0)).dynamic_candidates, 0u);
  config = PaperConfig{};
  apply_ablation(config, "no-dpp");
  const Frame frame = DynamicIcp(config, 1).process(street.scan(0));
  EXPECT_GT(frame.dynamic_candidates, 60u);
  EXPECT_TRUE(frame.clusters.empty());
  config = PaperConfig{};
  apply_ablation(config, "no-dr");
  DynamicIcp odometry(config, 1);
  odometry.process(street.scan(0));
  EXPECT_EQ(odometry.process(street.scan(1)).alignment.doppler.count, 0u);
}

TEST(DynamicIcp, SameBitsForAnyNumberOfThreadsAndEveryRun) {
  const Street street;
  const auto last_pose = [&](int threads) {
    DynamicIcp odometry(PaperConfig{}, threads);
    Frame frame;
    for (int k = 0; k < 4; ++k) {
      frame = odometry.process(street.scan(k));
    }
    return frame.T_world_sensor.matrix().eval();
  };
  const Eigen::Matrix4d expected = last_pose(1);
  for (const int threads : {1, 2, 7}) {
    EXPECT_EQ(last_pose(threads), expected) << threads;
  }
}

TEST(DynamicIcp, RefusesConfigurationsOutOfRange) {
  PaperConfig config;
  config.registration.max_iterations = 0;
  EXPECT_THROW(DynamicIcp(config, 1), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::odometry
