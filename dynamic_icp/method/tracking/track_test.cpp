// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/track.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kCarBody(4.5, 1.8, 1.5);

/// The rear and the right side of a car that drives straight; the sensor is in the origin, the points were measured
/// `time_s` after the stamp.
Detection car_at(const Vector3d& centre, const Vector3d& velocity, std::uint64_t seed, double time_s = 0.0,
                 const Vector3d& size = kCarBody) {
  const Eigen::Matrix3d axes = upright_axes(std::atan2(velocity.y(), velocity.x()));
  Detection detection;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const RandomSource one = RandomSource(seed).fork(i);
    Vector3d q(one.uniform(0, -0.5, 0.5), one.uniform(1, -0.5, 0.5), one.uniform(2, -0.5, 0.5));
    (i % 3 == 0 ? q.x() : q.y()) = -0.5;
    const Vector3d noise(0.02 * one.normal(3), 0.02 * one.normal(4), 0.0);
    detection.points.emplace_back(centre + time_s * velocity + axes * (q.cwiseProduct(size) + noise));
    detection.directions.push_back(detection.points.back().normalized());
    detection.radial.push_back(detection.directions.back().dot(velocity) + 0.05 * one.normal(5));
    detection.times.push_back(time_s);
  }
  detection.mean_time_s = time_s;
  return detection;
}

double largest_sigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
}

TEST(Track, FindsTheMotionThatOneScanLeavesOpen) {
  const TrackConfig config;
  const Vector3d velocity = 12.0 * upright_axes(0.5).col(0);
  Vector3d centre(25.0, 8.0, 0.0);
  Track track(car_at(centre, velocity, 1), 0.0, config);
  const double at_first = largest_sigma(track.estimate().velocity_covariance);
  for (std::uint64_t scan = 2; scan < 12; ++scan) {
    centre += 0.1 * velocity;
    track.correct(car_at(centre, velocity, scan), 0.1 * static_cast<double>(scan - 1), config);
  }
  EXPECT_LT((track.body().velocity() - velocity).norm(), 0.5);
  EXPECT_LT((track.estimate().box.centre - centre).head<2>().norm(), 0.5);
  EXPECT_GT(std::abs(track.estimate().box.axes.col(0).dot(velocity.normalized())), 0.99);
  EXPECT_LT(largest_sigma(track.estimate().velocity_covariance), 0.5 * at_first);
}

TEST(Track, AHeadingThatTheMotionContradictsIsFoundAnew) {
  // First the rear of a car is taken for the side of one that drives to the right; what is seen next fits both.
  const TrackConfig config;
  const Vector3d to_the_right(0.0, -4.0, 0.0);
  const Vector3d ahead(4.0, 0.0, 0.0);
  Vector3d centre(20.0, 8.0, 0.0);
  Track track(car_at(centre, to_the_right, 1), 0.0, config);
  for (std::uint64_t scan = 2; scan < 40; ++scan) {
    const Vector3d velocity = scan < 14 ? to_the_right : ahead;
    centre += 0.1 * velocity;
    track.correct(car_at(centre, velocity, scan), 0.1 * static_cast<double>(scan - 1), config);
    if (scan == 13) {
      ASSERT_LT(track.estimate().box.axes.col(0).y(), -0.98) << "one hypothesis, that it drives to the right";
    }
  }
  EXPECT_GT(track.estimate().box.axes.col(0).x(), 0.98);
  EXPECT_LT((track.body().velocity() - ahead).norm(), 0.5);
}

TEST(Track, IsAtTheMeanTimeOfItsLastMeasurement) {
  const TrackConfig config;
  const Vector3d velocity(10.0, 0.0, 0.0);
  Track track(car_at({20.0, 5.0, 0.0}, velocity, 1, 0.04), 3.0, config);
  EXPECT_DOUBLE_EQ(track.time_s(), 3.04);
  track.correct(car_at({21.0, 5.0, 0.0}, velocity, 2, 0.06), 3.1, config);
  EXPECT_DOUBLE_EQ(track.time_s(), 3.16);
}

TEST(Track, PredictsAlongItsVelocityAndBackAgain) {
  const TrackConfig config;
  const Vector3d velocity(10.0, 0.0, 0.0);
  Track track(car_at({20.0, 5.0, 0.0}, velocity, 1), 0.0, config);
  const Vector3d position = track.body().position();
  const double sigma = largest_sigma(track.estimate().velocity_covariance);
  const Vector3d step = 0.3 * track.body().velocity();
  track.predict(0.3, config);
  EXPECT_LT((track.body().position() - position - step).norm(), 0.02 * step.norm() + 0.02);
  EXPECT_GT(largest_sigma(track.estimate().velocity_covariance), sigma) << "the future is less certain";
  track.predict(0.0, config);
  EXPECT_LT((track.body().position() - position).head<2>().norm(), 1e-6);
}

TEST(Track, CovarianceIncludesTheDisagreementOfTheHypotheses) {
  // Sides tell the direction up to quarter turns. Of a short body seen over a corner either may be the front: with the
  // same radial velocity it drives along either of them, if it turns.
  const TrackConfig config;
  const Vector3d velocity = 3.0 * upright_axes(-0.25 * std::numbers::pi).col(0);
  const Track track(car_at({25.0, 0.0, 0.0}, velocity, 1, 0.0, {2.3, 2.1, 1.5}), 0.0, config);
  const BoxEstimate best = track.best().estimate();
  const BoxEstimate all = track.estimate();
  EXPECT_GT(std::sqrt(all.velocity_covariance(1, 1)), 1.0) << "the other way it moves by 4.2 m/s";
  EXPECT_GT(all.velocity_covariance(1, 1), 2.0 * best.velocity_covariance(1, 1));
  EXPECT_LT(std::sqrt(all.velocity_covariance(0, 0)), 0.3) << "along the line of sight they agree";
}

/// Of something that drives away a part of its rear, with a height of `height_m`; `speed_mps` by the number of the
/// scan.
Track track_of_part(const std::function<double(int)>& speed_mps, double height_m, const TrafficPrior* traffic = nullptr,
                    int scans = 20) {
  const TrackConfig config;
  const Vector3d size(0.2, 0.7, height_m);
  Vector3d centre(20.0, -2.0, 0.0);
  std::optional<Track> track;
  for (int scan = 0; scan < scans; ++scan) {
    const Vector3d velocity(speed_mps(scan), 0.0, 0.0);
    Detection detection = car_at(centre, velocity, static_cast<std::uint64_t>(scan) + 1, 0.0, size);
    detection.traffic = traffic;
    if (track) {
      track->correct(detection, 0.1 * scan, config);
    } else {
      track.emplace(detection, 0.0, config);
    }
    centre += 0.1 * velocity;
  }
  return *track;
}

Track track_of_part(double speed_mps, double height_m, const TrafficPrior* traffic = nullptr, int scans = 20) {
  return track_of_part([&](int /*scan*/) { return speed_mps; }, height_m, traffic, scans);
}

TEST(Track, WhatIsFasterThanAPersonPointsWhereItMovesThoughLittleIsSeenOfIt) {
  const Track vehicle = track_of_part(6.0, 2.0);
  ASSERT_TRUE(vehicle.best().has_heading());
  EXPECT_GT(vehicle.estimate().box.axes.col(0).x(), 0.98);
  EXPECT_GT(vehicle.estimate().box.size.x(), 2.0) << "there is more of it ahead";
  EXPECT_GT(vehicle.estimate().box.centre.x(), vehicle.best().seen_box().centre.x() + 0.9);
  const Track person = track_of_part(1.5, 1.8);
  EXPECT_FALSE(person.best().has_heading());
  EXPECT_LT(person.estimate().box.size.head<2>().maxCoeff(), 1.0);
}

TEST(Track, AVehicleThatSlowsDownIsNoPerson) {
  const Track braking = track_of_part([](int scan) { return std::max(1.0, 6.0 - 0.5 * scan); }, 2.0);
  EXPECT_NEAR(braking.body().velocity().norm(), 1.0, 0.1);
  EXPECT_GT(braking.estimate().box.size.x(), 2.0);
}

TEST(Track, OfWhatLittleIsSeenTheTrafficTellsTheHeading) {
  TrafficPrior traffic;
  for (const double x : {10.0, 25.0, 40.0}) {
    traffic.add({x, -8.0, 0.0}, Vector3d::UnitX(), 3.0);
  }
  // Slower than a person may be, and 6 degrees off the line of sight.
  const Track alone = track_of_part(2.0, 2.4);
  EXPECT_FALSE(alone.best().has_heading());
  const Track among_others = track_of_part(2.0, 2.4, &traffic);
  ASSERT_TRUE(among_others.best().has_heading());
  EXPECT_GT(among_others.estimate().box.axes.col(0).x(), 0.99);
  const auto across_sigma = [](const Track& track) { return std::sqrt(track.estimate().velocity_covariance(1, 1)); };
  EXPECT_NEAR(among_others.body().velocity().y(), 0.0, 0.2);
  EXPECT_LT(across_sigma(track_of_part(2.0, 2.4, &traffic, 3)), 0.7 * across_sigma(track_of_part(2.0, 2.4, nullptr, 2)))
      << "before its way shows the direction";
}

TEST(Track, APersonWhoCrossesDoesNotGoTheWayOfTheTraffic) {
  TrafficPrior traffic;
  for (const double x : {20.0, 30.0, 40.0, 50.0}) {
    traffic.add({x, -16.0, 0.0}, Vector3d::UnitX(), 1.5);
  }
  const TrackConfig config;
  const Vector3d velocity(0.0, 1.3, 0.0);
  const auto seen_in = [&](int scan, std::uint64_t seed) {
    Detection detection;
    for (int i = 0; i < 16; ++i) {
      const RandomSource one = RandomSource(seed).fork(static_cast<std::uint64_t>(100 * scan + i));
      const double around = one.uniform(0, 0.7 * std::numbers::pi, 1.6 * std::numbers::pi);  // what faces the sensor
      const Vector3d on_body(0.25 * std::cos(around), 0.25 * std::sin(around), 0.25 * (i % 7) - 0.85);
      detection.points.emplace_back(Vector3d(38.0, -20.0, 0.0) + 0.1 * scan * velocity + on_body);
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity) + 0.1 * one.normal(1));
      detection.times.push_back(0.0);
    }
    detection.traffic = &traffic;
    return detection;
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Track track(seen_in(0, seed), 0.0, config);
    for (int scan = 1; scan < 12; ++scan) {
      track.correct(seen_in(scan, seed), 0.1 * scan, config);
    }
    EXPECT_LT((track.body().velocity() - velocity).norm(), 0.5) << "seed " << seed;
  }
}

TEST(Track, AFastMotionOfWhatLittleIsSeenIsNotBelievedAgainstTheTraffic) {
  // The first points of a car that comes into view; their Doppler errs by 0.3 m/s from one end to the other, as if it
  // crossed the line of sight at 25 m/s.
  TrafficPrior traffic;
  for (const double x : {10.0, 15.0, 20.0, 25.0, 30.0}) {
    traffic.add({x, 3.0, 0.0}, Vector3d::UnitX(), 2.0);
  }
  const TrackConfig config;
  const Vector3d velocity(2.0, 0.0, 0.0);
  std::optional<Track> track;
  for (int scan = 0; scan < 4; ++scan) {
    Detection detection;
    for (int i = 0; i < 16; ++i) {
      const double across = (i % 4 - 1.5) / 3.0;
      detection.points.emplace_back(16.0 + 0.2 * scan, 10.0 + 0.2 * (1 + scan) * across, 0.1 * (i / 4));
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity) + (scan == 0 ? 0.3 * across : 0.0));
      detection.times.push_back(0.0);
    }
    detection.traffic = &traffic;
    if (track) {
      track->correct(detection, 0.1 * scan, config);
    } else {
      track.emplace(detection, 0.0, config);
    }
  }
  EXPECT_GT(std::abs(track->estimate().box.axes.col(0).x()), 0.95);
}

TEST(Track, WhatLooksLikeASideIsNotBelievedAgainstTheTrafficAndTheMotion) {
  // The edge of what is seen of a roof runs aslant, as a nearer body cuts it off.
  TrafficPrior traffic;
  for (const double x : {10.0, 15.0, 20.0, 25.0, 30.0}) {
    traffic.add({x, 3.0, 0.0}, Vector3d::UnitX(), 5.0);
  }
  const TrackConfig config;
  const Vector3d velocity(5.0, 0.0, 0.0);
  std::optional<Track> track;
  for (int scan = 0; scan < 8; ++scan) {
    Detection detection;
    for (int i = 0; i < 30; ++i) {
      const double along = i / 29.0;
      const Vector3d on_edge(20.0 + 2.0 * along, -8.0 - 1.2 * along, 0.1 * (i % 3));
      detection.points.emplace_back(on_edge + 0.1 * scan * velocity);
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity));
      detection.times.push_back(0.0);
    }
    detection.traffic = &traffic;
    if (track) {
      track->correct(detection, 0.1 * scan, config);
    } else {
      track.emplace(detection, 0.0, config);
    }
  }
  EXPECT_GT(track->estimate().box.axes.col(0).x(), 0.98);
}

TEST(Track, WhatCrossesTheTrafficDoesSo) {
  // Sides are believed against what others do.
  TrafficPrior traffic;
  for (const double x : {10.0, 15.0, 20.0, 25.0, 30.0}) {
    traffic.add({x, 6.0, 0.0}, Vector3d::UnitX(), 10.0);
  }
  const TrackConfig config;
  const Vector3d velocity(0.0, 6.0, 0.0);
  Vector3d centre(18.0, -8.0, 0.0);
  std::optional<Track> track;
  for (int scan = 0; scan < 12; ++scan) {
    Detection detection = car_at(centre, velocity, static_cast<std::uint64_t>(scan) + 1);
    detection.traffic = &traffic;
    if (track) {
      track->correct(detection, 0.1 * scan, config);
    } else {
      track.emplace(detection, 0.0, config);
    }
    centre += 0.1 * velocity;
  }
  EXPECT_GT(track->estimate().box.axes.col(0).y(), 0.99);
  EXPECT_LT((track->body().velocity() - velocity).norm(), 0.5);
}

TEST(Track, SidesThatComeIntoViewCorrectAHeadingByMotion) {
  const TrackConfig config;
  const Vector3d velocity(0.0, 7.0, 0.0);
  const auto velocity_error = [](Detection detection) {  // a part that seems to move otherwise at first
    for (std::size_t i = 0; i < detection.radial.size(); ++i) {
      detection.radial[i] = detection.directions[i].dot(Vector3d(7.0, 1.0, 0.0));
    }
    return detection;
  };
  Vector3d centre(4.0, 2.0, 0.0);
  Track track(velocity_error(car_at(centre, velocity, 1, 0.0, {0.5, 0.5, 2.0})), 0.0, config);
  for (std::uint64_t scan = 2; scan < 12; ++scan) {
    centre += 0.1 * velocity;
    track.correct(car_at(centre, velocity, scan, 0.0, {6.0, 2.3, 2.5}), 0.1 * static_cast<double>(scan - 1), config);
  }
  EXPECT_GT(std::abs(track.estimate().box.axes.col(0).y()), 0.98);
  EXPECT_NEAR(track.estimate().box.size.x(), 6.0, 0.6);
  EXPECT_NEAR(track.estimate().box.size.y(), 2.3, 0.4);
}

}  // namespace
}  // namespace dynamic_icp::tracking
