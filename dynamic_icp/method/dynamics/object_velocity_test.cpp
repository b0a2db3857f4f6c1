// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/dynamics/object_velocity.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::dynamics {
namespace {

using Eigen::Vector3d;

struct Cluster {
  Scan scan;
  std::vector<double> compensated;
  std::vector<std::int32_t> labels;
};

/// n points in a box at `centre`, moving with `velocity` over ground.
Cluster cluster(unsigned seed, std::size_t n, const Vector3d& centre, const Vector3d& size, const Vector3d& velocity,
                double noise_mps = 0.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::normal_distribution<double> normal;
  RawScan raw;
  for (std::size_t i = 0; i < n; ++i) {
    raw.points.push_back(centre + size.cwiseProduct(Vector3d(uniform(random), uniform(random), uniform(random))));
    raw.doppler.push_back(raw.points.back().normalized().dot(velocity) + noise_mps * normal(random));
  }
  Cluster result{Scan::from_raw(raw), {}, std::vector<std::int32_t>(n, 0)};
  result.compensated = result.scan.doppler();  // a sensor at rest
  return result;
}

ObjectEstimate only_object(const Cluster& c, const ObjectVelocityConfig& config = {}) {
  const std::vector<ObjectEstimate> objects = reconstruct_velocities(c.scan, c.compensated, c.labels, config);
  EXPECT_EQ(objects.size(), 1u);
  return objects.at(0);
}

const Vector3d kNear(8.0, 2.0, 0.0);
const Vector3d kCarSize(4.0, 2.0, 1.5);

TEST(ObjectVelocity, IsExactWithoutNoise) {
  const Vector3d v(9.0, -3.0, 0.2);
  const ObjectEstimate object = only_object(cluster(1, 100, kNear, kCarSize, v));
  EXPECT_EQ(object.verdict, ClusterVerdict::kAccepted);
  EXPECT_LT((object.velocity_sensor - v).norm(), 1e-9);
  EXPECT_EQ(object.members.size(), 100u);
  EXPECT_LT((object.centroid - kNear).norm(), 0.5);
  EXPECT_NEAR(object.extent.x(), 4.0, 0.3);
}

TEST(ObjectVelocity, EqualsTheOrthogonalLeastSquaresSolution) {
  const Cluster c = cluster(2, 80, kNear, kCarSize, {7.0, 1.0, 0.0}, 0.05);
  Eigen::MatrixX3d U(80, 3);
  for (Eigen::Index i = 0; i < 80; ++i) {
    U.row(i) = c.scan.directions()[static_cast<std::size_t>(i)];
  }
  const Eigen::Map<const Eigen::VectorXd> s(c.compensated.data(), 80);
  const Vector3d expected = dense::least_squares(U, s);
  const Eigen::VectorXd singular = dense::singular_values(U);
  const ObjectEstimate object = only_object(c);
  EXPECT_LT((object.velocity_sensor - expected).norm(), 1e-9);
  EXPECT_NEAR(object.smallest_singular_value, singular[2], 1e-9);
  EXPECT_NEAR(object.condition_number, singular[0] / singular[2], 1e-6);
}

TEST(ObjectVelocity, HuberRegressionBearsGrossDopplerErrors) {
  const Vector3d v(10.0, 1.0, 0.0);
  Cluster c = cluster(10, 100, {20.0, 3.0, 0.0}, {2.0, 1.8, 1.4}, v, 0.05);
  c.compensated[7] += 25.0;
  ObjectVelocityConfig robust;
  robust.huber_delta_mps = 0.15;
  const ObjectEstimate plain = only_object(c);
  const ObjectEstimate estimate = only_object(c, robust);
  EXPECT_GT((plain.velocity_sensor - v).norm(), 3.0) << "otherwise the error is not gross enough for this test";
  EXPECT_LT((estimate.velocity_sensor - v).norm(), 0.8);
  EXPECT_EQ(estimate.verdict, ClusterVerdict::kAccepted);
}

TEST(ObjectVelocity, CovarianceCoversTheTrueErrorWithAndWithoutHuber) {
  const Vector3d v(10.0, 1.0, 0.0);
  for (const double delta : {0.0, 0.1}) {
    ObjectVelocityConfig config;
    config.huber_delta_mps = delta;
    double sum = 0.0;
    constexpr int kRepeats = 300;
    for (unsigned seed = 0; seed < kRepeats; ++seed) {
      const ObjectEstimate object = only_object(cluster(500 + seed, 120, kNear, kCarSize, v, 0.08), config);
      const Vector3d error = object.velocity_sensor - v;
      sum += error.dot(object.covariance.inverse() * error);
    }
    EXPECT_NEAR(sum / kRepeats, 3.0, 0.6) << "normalised error squared of three components, delta " << delta;
  }
}

TEST(ObjectVelocity, UncertainVelocitiesAreRejectedOnRequest) {
  const Cluster c = cluster(11, 60, {60.0, 0.0, 0.0}, {0.5, 1.8, 1.4}, {10.0, 0.0, 0.0}, 0.05);
  ObjectVelocityConfig config;
  config.huber_delta_mps = 0.15;
  EXPECT_EQ(only_object(c, config).verdict, ClusterVerdict::kAccepted);
  config.max_deviation_mps = 0.3;
  EXPECT_EQ(only_object(c, config).verdict, ClusterVerdict::kUncertain);
  EXPECT_TRUE(only_object(c, config).members.empty());
}

TEST(ObjectVelocity, LeavesOutPointsBeyondTheGate) {
  Cluster c = cluster(3, 200, kNear, kCarSize, {10.0, 0.0, 0.0});
  c.compensated[5] += 2.0;  // gate: 0.05 * 10 m/s
  const ObjectEstimate object = only_object(c);
  ASSERT_EQ(object.verdict, ClusterVerdict::kAccepted);
  EXPECT_TRUE(std::find(object.members.begin(), object.members.end(), 5u) == object.members.end());
  EXPECT_NEAR(object.inlier_fraction, static_cast<double>(object.members.size()) / 200.0, 1e-15);
}

TEST(ObjectVelocity, DistantObjectsAreIllConditioned) {
  const ObjectEstimate object = only_object(cluster(4, 100, {300.0, 0.0, 0.0}, {0.5, 2.0, 1.0}, {10.0, 0.0, 0.0}));
  EXPECT_EQ(object.verdict, ClusterVerdict::kIllConditioned);
  EXPECT_GT(object.condition_number, 400.0);
  EXPECT_TRUE(object.members.empty());
}

TEST(ObjectVelocity, PointsOfDifferentVelocityAreNoObject) {
  Cluster c = cluster(5, 100, kNear, kCarSize, {10.0, 0.0, 0.0});
  for (std::size_t i = 0; i < 100; ++i) {
    c.compensated[i] = i % 2 == 0 ? 10.0 : -10.0;
  }
  EXPECT_EQ(only_object(c).verdict, ClusterVerdict::kTooFewInliers);
}

TEST(ObjectVelocity, DegenerateClustersSayWhy) {
  EXPECT_EQ(only_object(cluster(6, 2, kNear, kCarSize, {1, 0, 0})).verdict, ClusterVerdict::kTooFewPoints);
  const ObjectEstimate one_ray = only_object(cluster(7, 50, kNear, Vector3d::Zero(), {1, 0, 0}));
  EXPECT_EQ(one_ray.verdict, ClusterVerdict::kIllConditioned);
  EXPECT_TRUE(std::isfinite(one_ray.condition_number));
  const ObjectEstimate static_frame = only_object(cluster(8, 50, kNear, kCarSize, Vector3d::Zero()));
  EXPECT_EQ(static_frame.verdict, ClusterVerdict::kAccepted);
  EXPECT_EQ(to_string(ObjectEstimate{}.verdict), "not_run");
}

TEST(ObjectVelocity, EachLabelHasItsEntry) {
  Cluster c = cluster(9, 60, kNear, kCarSize, {5.0, 0.0, 0.0});
  for (std::size_t i = 0; i < 60; ++i) {
    c.labels[i] = i < 20 ? -1 : i < 40 ? 1 : 0;
  }
  const std::vector<ObjectEstimate> objects = reconstruct_velocities(c.scan, c.compensated, c.labels, {});
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0].members.front(), 40u);
  EXPECT_EQ(objects[1].members.front(), 20u);
  EXPECT_TRUE(reconstruct_velocities(Scan{}, {}, {}, {}).empty());
}

}  // namespace
}  // namespace dynamic_icp::dynamics
