// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kSize(10.0, 2.4, 2.5);

/// The rear and the right side, up to a share `seen` of its length from the rear, of a lorry that drives straight with
/// `velocity`; the sensor is in the origin.
Detection detection_of(const Vector3d& centre, const Vector3d& velocity, double seen, std::uint64_t seed) {
  const Eigen::Matrix3d axes = upright_axes(std::atan2(velocity.y(), velocity.x()));
  Detection detection;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = RandomSource(seed).fork(i);
    Vector3d q(seen * one.uniform(0) - 0.5, one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = -0.5;
    const Vector3d noise(0.02 * one.normal(3), 0.02 * one.normal(4), 0.0);
    detection.points.emplace_back(centre + axes * (q.cwiseProduct(kSize) + noise));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(detection.directions.back().dot(velocity) + 0.05 * one.normal(5));
    detection.times.push_back(0.0);
  }
  return detection;
}

TEST(BoxFilter, SidesShowTheDirectionOfTheMotion) {
  // Born with a direction that is wrong by 0.2 rad: the Doppler hardly shows it, displacements only after a while.
  const Vector3d velocity = 10.0 * upright_axes(0.4).col(0);
  Vector3d centre(25, 6, 0);
  const TrackConfig config;
  BoxFilter filter(detection_of(centre, velocity, 1.0, 1), 0.2, config);
  for (std::uint64_t k = 2; k < 3; ++k) {
    centre += 0.1 * velocity;
    filter.predict(0.1, config);
    filter.correct(detection_of(centre, velocity, 1.0, k), config);
  }
  const Vector3d v = filter.motion().velocity();
  EXPECT_NEAR(std::atan2(v.y(), v.x()), 0.4, 0.05);
}

TEST(BoxFilter, ABoxThatGrowsStaysWhereItsTrueEndIs) {
  // Seen from behind; more of its length comes into view from scan to scan.
  const Vector3d velocity(10, 0, 0);
  Vector3d centre(25, 6, 0);
  const TrackConfig config;
  BoxFilter filter(detection_of(centre, velocity, 0.3, 1), 0.0, config);
  for (std::uint64_t k = 2; k < 12; ++k) {
    centre += 0.1 * velocity;
    filter.predict(0.1, config);
    filter.correct(detection_of(centre, velocity, std::min(1.0, 0.1 * static_cast<double>(k + 2)), k), config);
    const OrientedBox box = filter.box();
    EXPECT_NEAR(box.centre.x() - 0.5 * box.size.x(), centre.x() - 5.0, 0.1) << "scan " << k;
    EXPECT_NEAR(filter.motion().velocity().x(), 10.0, 0.1) << "scan " << k;
    EXPECT_NEAR(filter.motion().velocity().y(), 0.0, 0.5) << "scan " << k;
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
