// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/cluster_velocity.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kCentre(20, 6, 1);
const Vector3d kVelocity(3, 8, 0.2);
const Vector3d kRotation(0, 0, 0.6);

/// Points of a body around kCentre that moves with kVelocity and turns with kTurn, seen from the origin.
struct Body {
  std::vector<Vector3d> directions;
  std::vector<double> radial;

  explicit Body(std::size_t n, double sigma = 0.0, double outliers = 0.0) {
    const RandomSource random(5);
    for (std::size_t i = 0; i < n; ++i) {
      const RandomSource one = random.fork(i);
      const Vector3d point =
          kCentre + Vector3d(one.uniform(0, -2, 2), one.uniform(1, -2, 2), one.uniform(2, -0.8, 0.8));
      const Vector3d u = point.normalized();
      const bool outlier = one.uniform(3) < outliers;
      directions.push_back(u);
      radial.push_back(outlier ? one.uniform(4, -30.0, 30.0)
                               : u.dot(kVelocity + kRotation.cross(point - kCentre)) + sigma * one.normal(5));
    }
  }
};

TEST(ClusterVelocity, OfATurningBodyIsItsVelocityWithoutTheTurn) {
  const Body body(200);
  const ClusterVelocity fit = fit_cluster_velocity(body.directions, body.radial, 0.05);
  EXPECT_TRUE(fit.W.isApprox(kVelocity - kRotation.cross(kCentre), 1e-6)) << fit.W.transpose();
  EXPECT_GT(fit.information.trace(), 0.9 * 200.0 / (0.05 * 0.05)) << "no point is left out";
}

TEST(ClusterVelocity, GrossErrorsDoNotCount) {
  const Body clean(300, 0.05);
  const Body dirty(300, 0.05, 0.2);
  const ClusterVelocity a = fit_cluster_velocity(clean.directions, clean.radial, 0.05);
  const ClusterVelocity b = fit_cluster_velocity(dirty.directions, dirty.radial, 0.05);
  const Vector3d sight = kCentre.normalized();
  EXPECT_NEAR(a.W.dot(sight), b.W.dot(sight), 0.01);
  EXPECT_LT((a.W - b.W).norm(), 0.2);
  EXPECT_LT(b.information.trace(), 0.9 * a.information.trace()) << "they do not add information";
  EXPECT_LT(b.spread_mps, 0.1);
}

TEST(ClusterVelocity, ErrorsAreAsLargeAsTheInformationSays) {
  // Mean over many bodies of e^T I e, which is chi-squared with three degrees of freedom.
  double sum = 0.0;
  constexpr int kBodies = 200;
  const Body shape(100);
  for (std::uint64_t k = 0; k < kBodies; ++k) {
    const RandomSource noise = RandomSource(11).fork(k);
    std::vector<double> radial = shape.radial;
    for (std::size_t i = 0; i < radial.size(); ++i) {
      radial[i] += 0.05 * noise.normal(i);
    }
    const ClusterVelocity fit = fit_cluster_velocity(shape.directions, radial, 0.05);
    const Vector3d e = fit.W - (kVelocity - kRotation.cross(kCentre));
    sum += e.dot(fit.information * e);
  }
  EXPECT_GT(sum / kBodies, 2.4);
  EXPECT_LT(sum / kBodies, 3.9) << "the robust scale may be a little small for small samples";
}

TEST(ClusterVelocity, NoPointSaysNothingAndOneItsOwnDirection) {
  const ClusterVelocity none = fit_cluster_velocity({}, {}, 0.05);
  EXPECT_EQ(none.W, Vector3d::Zero());
  EXPECT_EQ(none.information, Eigen::Matrix3d::Zero());
  const std::vector<Vector3d> u = {Vector3d(0.6, 0.8, 0.0)};
  const ClusterVelocity one = fit_cluster_velocity(u, std::vector<double>{-4.0}, 0.05);
  EXPECT_TRUE(one.W.isApprox(-4.0 * u[0], 1e-9));
  EXPECT_NEAR(u[0].dot(one.information * u[0]), 400.0, 1e-6) << "1 / 0.05^2";
  EXPECT_NEAR((one.information * Vector3d::UnitZ()).norm(), 0.0, 1e-9);
}

TEST(ClusterVelocity, UnrelatedVelocitiesSpread) {
  const Body noise(50, 0.0, 1.0);
  EXPECT_GT(fit_cluster_velocity(noise.directions, noise.radial, 0.05).spread_mps, 1.0);
}

}  // namespace
}  // namespace dynamic_icp::tracking
