// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/filtered_box.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

/// The rear and the right side, up to a share `seen` of its length from the rear, of a lorry that drives straight with
/// `velocity`; the sensor is in the origin and nothing hides anything.
Detection rear_and_side(const Vector3d& centre, const Vector3d& velocity, double seen, std::uint64_t seed) {
  const Eigen::Matrix3d axes = upright_axes(std::atan2(velocity.y(), velocity.x()));
  Detection detection;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const RandomSource one = RandomSource(seed).fork(i);
    Vector3d q(seen * one.uniform(0) - 0.5, one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = -0.5;
    const Vector3d noise(0.02 * one.normal(3), 0.02 * one.normal(4), 0.0);
    detection.points.emplace_back(centre + axes * (q.cwiseProduct(kLorrySize_m) + noise));
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
  BoxFilter filter(rear_and_side(centre, velocity, 1.0, 1), 0.2, {}, config);
  for (std::uint64_t k = 2; k < 3; ++k) {
    centre += 0.1 * velocity;
    filter.predict(0.1, config);
    filter.correct(rear_and_side(centre, velocity, 1.0, k), config);
  }
  const Vector3d v = filter.body().velocity();
  EXPECT_NEAR(std::atan2(v.y(), v.x()), 0.4, 0.05);
}

TEST(BoxFilter, FrontsAreBeyondTheRoundCornersThatHideThem) {
  // A car of 4.4 m seen from behind and beside: rear and right side, and of the corner in front, a quarter of a
  // circle, what does not hide itself.
  constexpr double kRadius_m = 0.5;
  constexpr double kFront_m = 4.4;
  const Vector3d velocity(10, 0, 0);
  for (const auto& [ahead_m, left_m] : {std::pair(2.0, 3.0), std::pair(4.0, 3.0), std::pair(12.0, 6.0)}) {
    const Vector3d rear(ahead_m, left_m, -1.0);  // its right edge, on the ground
    Detection detection;
    detection.ground.offset_m = -1.0;
    const auto add = [&](double x, double y, double z) {
      detection.points.emplace_back(rear + Vector3d(x, y, z));
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity));
      detection.times.push_back(0.0);
    };
    for (double z = 0.3; z <= 1.5; z += 0.1) {
      for (double y = 0.0; y <= 1.8; y += 0.1) {
        add(0.0, y, z);
      }
      for (double x = 0.0; x <= kFront_m - kRadius_m; x += 0.05) {
        add(x, 0.0, z);
      }
      for (double angle = 0.0; angle <= 0.5 * std::numbers::pi; angle += 0.02) {
        const Vector3d normal(std::sin(angle), -std::cos(angle), 0.0);
        const Vector3d place(kFront_m - kRadius_m + kRadius_m * normal.x(), kRadius_m + kRadius_m * normal.y(), z);
        if (normal.dot(rear + place) < 0.0) {
          add(place.x(), place.y(), z);
        }
      }
    }
    const BoxFilter filter(detection, 0.0, {}, {});
    EXPECT_NEAR(filter.estimate().box.size.x(), kFront_m, 0.15) << ahead_m;
    EXPECT_NEAR(middle_of(filter.estimate().box, Face::kFront).x(), ahead_m + kFront_m, 0.15) << ahead_m;
  }
}

TEST(BoxFilter, ABoxThatGrowsStaysWhereItsTrueEndIs) {
  // Seen from behind; more of its length comes into view from scan to scan.
  const Vector3d velocity(10, 0, 0);
  Vector3d centre(25, 6, 0);
  const TrackConfig config;
  BoxFilter filter(rear_and_side(centre, velocity, 0.3, 1), 0.0, {}, config);
  for (std::uint64_t k = 2; k < 12; ++k) {
    centre += 0.1 * velocity;
    filter.predict(0.1, config);
    filter.correct(rear_and_side(centre, velocity, std::min(1.0, 0.1 * static_cast<double>(k + 2)), k), config);
    EXPECT_NEAR(middle_of(filter.estimate().box, Face::kRear).x(), centre.x() - 5.0, 0.1) << "scan " << k;
    EXPECT_NEAR(filter.body().velocity().x(), 10.0, 0.1) << "scan " << k;
    EXPECT_NEAR(filter.body().velocity().y(), 0.0, 0.5) << "scan " << k;
  }
}

TEST(BoxFilter, AnEndThatWasNoneSpeaksAgainstTheMotion) {
  // Seen from behind, to 0.3 of its length: it stays where the sensor sees it, or 1.5 m behind where it should be.
  const Vector3d velocity(10, 0, 0);
  const Vector3d centre(25, 6, 0);
  const TrackConfig config;
  const auto log_likelihood = [&](double behind_m) {
    BoxFilter filter(rear_and_side(centre, velocity, 0.3, 1), 0.0, {}, config);
    for (std::uint64_t k = 2; k < 6; ++k) {
      const bool is_last = k == 5;
      const Vector3d moved = 0.1 * static_cast<double>(k - 1) * velocity;
      filter.predict(0.1, config);
      filter.correct(rear_and_side(centre + moved - Vector3d(is_last ? behind_m : 0.0, 0.0, 0.0), velocity, 0.3, k),
                     config);
    }
    return filter.log_likelihood();
  };
  EXPECT_LT(log_likelihood(1.5), log_likelihood(0.0) - 4.0);
}

TEST(BoxFilter, AStripAlongTheLineOfSightHasNoDirection) {
  // What a slit between nearer bodies shows of a roof, 60 degrees to the left; the body drives ahead.
  const Eigen::Matrix3d along_sight = upright_axes(std::numbers::pi / 3.0);
  const Vector3d velocity(5, 0, 0);
  const auto seen = [&](double width) {
    Detection detection;
    for (double r = 6.0; r <= 8.0; r += 0.1) {
      for (double y = -0.5 * width; y <= 0.5 * width + 1e-9; y += 0.05) {
        detection.points.emplace_back(along_sight * Vector3d(r, y, -0.4));
        detection.directions.push_back(detection.points.back().normalized());
        detection.radial.push_back(detection.directions.back().dot(velocity));
        detection.times.push_back(0.0);
      }
    }
    return detection;
  };
  EXPECT_TRUE(is_strip_along_sight(seen(0.3).points, along_sight, Vector3d::Zero()));
  EXPECT_FALSE(is_strip_along_sight(seen(1.8).points, along_sight, Vector3d::Zero())) << "a body that drives away";
  EXPECT_FALSE(is_strip_along_sight(seen(0.3).points, along_sight, {3.0, 0.0, 0.0})) << "a side";
  const TrackConfig config;
  const auto yaw_after = [&](double width) {
    std::optional<BoxFilter> filter;
    for (int k = 0; k < 3; ++k) {
      take_in(filter, seen(width), std::numbers::pi / 3.0 - 0.2, config);
    }
    return filter->body().yaw();
  };
  EXPECT_LT(yaw_after(0.3), std::numbers::pi / 3.0 - 0.08) << "little but where its ends are";
  EXPECT_GT(yaw_after(1.8), std::numbers::pi / 3.0 - 0.06);
}

TEST(BoxFilter, AHoodDoesNotLowerARoofThatWasSeen) {
  // The side of a car and its roof; then the front part of it alone, which is 0.6 m lower.
  const Vector3d velocity(3, 0, 0);
  const TrackConfig config;
  std::optional<BoxFilter> filter;
  for (int k = 0; k < 8; ++k) {
    const double moved = 0.1 * k * velocity.x();
    const bool is_hood = k >= 4;
    Detection detection;
    detection.ground.offset_m = -1.9;
    for (double x = is_hood ? 9.0 : 6.0; x <= (is_hood ? 10.0 : 9.0); x += 0.1) {
      for (double z = -1.6; z <= (is_hood ? -1.0 : -0.4); z += 0.1) {
        detection.points.emplace_back(x + moved, -5.0, z);
        detection.directions.push_back(detection.points.back().normalized());
        detection.radial.push_back(detection.directions.back().dot(velocity));
        detection.times.push_back(0.0);
      }
    }
    take_in(filter, detection, 0.0, config);
    EXPECT_NEAR(filter->estimate().box.size.z(), 1.5, 0.15) << "scan " << k;
    EXPECT_NEAR(filter->body().velocity().z(), 0.0, 0.2) << "scan " << k;
  }
}

TEST(BoxFilter, TwoPointsOfSomethingElseMoveNoFace) {
  // Of a body whose right side was seen few points are left, and two, 2 m beside them, that another one has left.
  const Vector3d velocity(10, 0, 0);
  Vector3d centre(25, 6, 0);
  const TrackConfig config;
  BoxFilter filter(rear_and_side(centre, velocity, 1.0, 1), 0.0, {}, config);
  for (std::uint64_t k = 2; k < 8; ++k) {
    centre += 0.1 * velocity;
    Detection detection = rear_and_side(centre, velocity, 1.0, k);
    if (k == 7) {
      detection.points.resize(60);
      detection.points.emplace_back(centre + Vector3d(1.0, -3.3, 0.0));
      detection.points.emplace_back(centre + Vector3d(1.0, -3.4, 0.0));
      detection.directions.clear();
      for (const Vector3d& point : detection.points) {
        detection.directions.push_back(point.normalized());
      }
      detection.radial.resize(detection.points.size(), detection.directions.back().dot(velocity));
      detection.times.resize(detection.points.size());
    }
    filter.predict(0.1, config);
    filter.correct(detection, config);
  }
  EXPECT_NEAR(middle_of(filter.estimate().box, Face::kRight).y(), centre.y() - 0.5 * kLorrySize_m.y(), 0.1);
}

TEST(BoxFilter, TwoBodiesSideBySideDoNotSettleAHeading) {
  // Rears of two lorries in one plane are as wide as no body is along the road, and as the side of one across it.
  const Vector3d velocity(5, 0, 0);
  Detection detection;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const RandomSource one = RandomSource(1).fork(i);
    detection.points.emplace_back(80.0 + 0.02 * one.normal(0), one.uniform(1, -2.8, 2.8), one.uniform(2, -1.0, 1.5));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(detection.directions.back().dot(velocity) + 0.05 * one.normal(5));
    detection.times.push_back(0.0);
  }
  const TrackConfig config;
  const double along = BoxFilter(detection, 0.0, {}, config).log_likelihood();
  const double across = BoxFilter(detection, 0.5 * std::numbers::pi, {}, config).log_likelihood();
  EXPECT_GT(along, across - 3.0);
}

TEST(BoxFilter, WhatMovesBackwardsWasTakenTheWrongWayRound) {
  const Vector3d velocity(10, 0, 0);
  const TrackConfig config;
  BoxFilter filter(rear_and_side({25, 6, 0}, velocity, 1.0, 1), std::numbers::pi, {}, config);
  const BoxEstimate estimate = filter.estimate();
  EXPECT_GT(estimate.box.axes.col(0).dot(velocity), 9.9);
  EXPECT_NEAR(middle_of(estimate.box, Face::kRear).x(), 20.0, 0.3);
}

/// All faces of a body whose every face is measured with the noise that the filter takes for it: each is displaced as a
/// whole, and so is the ground.
Detection whole_body(const MovingBox& body, const RandomSource& random, const TrackConfig& config) {
  Detection detection;
  const auto sigma = [&](const Vector3d& at) { return config.face_sigma_m + config.face_sigma_growth * at.norm(); };
  Vector3d high;
  Vector3d low;
  for (const int axis : {0, 1, 2}) {
    const auto stream = static_cast<std::uint64_t>(2 * axis);
    high[axis] = 0.5 * body.box.size[axis] + sigma(body.box.centre) * random.normal(stream);
    low[axis] = -0.5 * body.box.size[axis] + sigma(body.box.centre) * random.normal(stream + 1);
  }
  const auto add = [&](const Vector3d& share) {
    const Vector3d q = low + share.cwiseProduct(high - low);
    const Vector3d point = body.box.centre + body.box.axes * q;
    detection.points.push_back(point);
    detection.directions.push_back(point.normalized());
    const std::uint64_t stream = 100 + detection.points.size();
    const Vector3d arm = point - body.box.centre;
    const Vector3d velocity = body.velocity + body.yaw_rate * Vector3d::UnitZ().cross(arm);
    detection.radial.push_back(point.normalized().dot(velocity) + config.doppler_sigma_mps * random.normal(stream));
    detection.times.push_back(0.0);
  };
  // Rear and right side in a grid with many points at the edges: none of the trimmed ones is missed.
  for (int i = 0; i <= 12; ++i) {
    for (int k = 0; k <= 6; ++k) {
      add({i / 12.0, 0.0, k / 6.0});
      add({0.0, i / 12.0, k / 6.0});
    }
  }
  detection.ground.offset_m = -kSensorHeight_m + (0.05 + sigma(body.box.centre)) * random.normal(50);
  // The Doppler shares an error, too.
  const double shared = config.doppler_floor_mps * random.normal(51);
  for (double& radial : detection.radial) {
    radial += shared;
  }
  return detection;
}

TEST(BoxFilter, CovarianceOfTheCentreIsThatOfItsErrors) {
  // Of a body of which all faces are seen, when it moves with the noise that the filter takes for it. 3 would be right
  // if it were not a box, as bodies are not; this one is.
  constexpr int kRuns = 150;
  const TrackConfig config;
  double sum = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const RandomSource random = RandomSource(41).fork(run);
    double yaw = 0.3;
    double speed = 9.0;
    double acceleration = config.motion.acceleration_mps2 * random.normal(901);
    MovingBox body = moving_body(20, 5, yaw, speed, {4.5, 1.8, 1.5});
    body.yaw_rate = 0.1 * random.normal(900);
    std::optional<BoxFilter> filter;
    for (std::uint64_t k = 0; k < 8; ++k) {
      if (filter) {
        constexpr int kSteps = 10;
        const double dt = kScanPeriod_s / kSteps;
        for (std::uint64_t i = 0; i < kSteps; ++i) {
          const RandomSource one = random.fork(1000 + 100 * k + i);
          speed += dt * acceleration + config.motion.across_mps * std::sqrt(dt) * one.normal(0);
          acceleration += -dt / 2.0 * acceleration + config.motion.acceleration_mps2 * std::sqrt(dt) * one.normal(2);
          body.yaw_rate += config.motion.yaw_rate_rps * std::sqrt(dt) * one.normal(1);
          yaw += dt * body.yaw_rate;
          body.box.axes = upright_axes(yaw);
          body.velocity = speed * body.box.axes.col(0);
          body.box.centre += dt * body.velocity;
        }
        filter->predict(kScanPeriod_s, config);
        filter->correct(whole_body(body, random.fork(k), config), config);
      } else {
        filter.emplace(whole_body(body, random.fork(k), config), yaw, BoxHistory{}, config);
      }
    }
    const BoxEstimate estimate = filter->estimate();
    sum += dense::normalised_squared(estimate.box.centre - body.box.centre, estimate.centre_covariance);
  }
  RecordProperty("mean", std::to_string(sum / kRuns));
  EXPECT_GT(sum / kRuns, 0.5) << "the filter allows for errors in the yaw of the sides that are not here";
  EXPECT_LT(sum / kRuns, 4.0);
}

TEST(BoxFilter, ABodyWithoutHeadingIsInItsBox) {
  // The box of such a body points where it moves, whatever the line of sight: its points lie within, and its size is
  // theirs along the axes of the box.
  const TrackConfig config;
  const Vector3d velocity(1.5, 0, 0);
  const Detection detection = rear_and_side({12, 9, 0}, velocity, 0.3, 3);
  const BoxFilter filter(detection, std::nullopt, {}, config);
  const OrientedBox box = filter.estimate().box;
  double farthest = 0.0;
  for (const Vector3d& point : detection.points) {
    farthest = std::max(farthest, distance_outside(box, point));
  }
  EXPECT_LT(farthest, 0.4);
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(box.size[axis], span_along(detection.points, box.centre, box.axes.col(axis), 0.0).length(), 0.5);
  }
}

TEST(BoxFilter, OfAPartWithoutHeadingTheCentreIsAsUncertainAsWhatIsHidden) {
  // Half a metre of a lorry, seen through a slit: its sides show no direction, and its centre is metres away.
  const TrackConfig config;
  const MovingBox lorry = moving_body(0, -9, 0.0, 8, kLorrySize_m);
  Detection detection;
  for (int i = 0; i < 60; ++i) {
    const Vector3d point(4.0 + 0.5 * (i % 10) / 10.0, -9 + 0.5 * kLorrySize_m.y(), -1.0 + 0.25 * (i / 10));
    detection.points.push_back(point);
    detection.directions.push_back(point.normalized());
    detection.radial.push_back(point.normalized().dot(lorry.velocity));
    detection.times.push_back(0.0);
  }
  BoxFilter filter(detection, std::nullopt, {}, config);
  EXPECT_GT(filter.body().velocity().norm(), 2.5) << "no person";
  const BoxEstimate estimate = filter.estimate();
  const Eigen::Vector3d deviations = estimate.centre_covariance.diagonal().cwiseSqrt();
  EXPECT_GT(deviations.head<2>().maxCoeff(), 0.5);
}

TEST(BoxFilter, WhatIsHiddenOnAllSidesIsNoPerson) {
  // Something as small and slow as a person: seen to its ends, and between two things that are nearer.
  const TrackConfig config;
  for (const bool is_between : {false, true}) {
    RawScan raw;
    for (double y = -0.25; y <= 0.25; y += 0.02) {
      for (double z = -1.2; z <= -0.4; z += 0.05) {
        raw.points.emplace_back(10.0, y, z);
      }
    }
    const std::size_t count = raw.points.size();
    for (double y = -4.0; y <= 4.0; y += 0.01) {
      for (double z = -1.5; z <= 1.0 && is_between && std::abs(y) > 0.15; z += 0.02) {
        raw.points.emplace_back(5.0, y, z);
      }
      raw.points.emplace_back(40.0, 5.0 * y, 0.0);
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const Scan scan = Scan::from_raw(raw);
    std::vector<std::uint32_t> rows(count);
    std::iota(rows.begin(), rows.end(), 0u);
    std::vector<double> radial(scan.size(), 1.5);
    const RangeImage image(scan, Vector3d::Zero(), Workers(1));
    Detection detection;
    make_detection(scan, radial, rows, SensorMotion{}, GroundHeights({Eigen::Matrix3d::Identity(), -1.5}), &image,
                   detection);
    const BoxEstimate estimate = BoxFilter(detection, 0.0, {}, config).estimate();
    EXPECT_EQ(estimate.box.size.x() > 2.0, is_between) << "a part of a vehicle";
    EXPECT_EQ(estimate.box.size.y() > 1.4, is_between);
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
