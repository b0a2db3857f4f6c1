// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"

#include "testing/boxes_in_view.hpp"
#include "testing/dense_algebra.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kLorry(10.0, 2.4, 3.0);

FaceView view_of_face(const BoxEstimate& estimate, Face face) { return estimate.faces[static_cast<std::size_t>(face)]; }

/// Middle of a face, world.
Vector3d middle_of(const OrientedBox& box, Face face) {
  const int axis = axis_of(face);
  return box.centre + side_of(face) * 0.5 * box.size[axis] * box.axes.col(axis);
}

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
    detection.points.emplace_back(centre + axes * (q.cwiseProduct(kLorry) + noise));
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

TEST(BoxFilter, WhatMovesBackwardsWasTakenTheWrongWayRound) {
  const Vector3d velocity(10, 0, 0);
  const TrackConfig config;
  BoxFilter filter(rear_and_side({25, 6, 0}, velocity, 1.0, 1), std::numbers::pi, {}, config);
  const BoxEstimate estimate = filter.estimate();
  EXPECT_GT(estimate.box.axes.col(0).dot(velocity), 9.9);
  EXPECT_NEAR(middle_of(estimate.box, Face::kRear).x(), 20.0, 0.3);
}

/// What the filter sees of the first of some bodies, as rays of a sensor meet them. Everything holds still in a scan.
struct Scene {
  View view;
  RangeImage image;
  Detection detection;

  Scene(const std::vector<MovingBox>& boxes, double time_s)
      : view(view_of(boxes, time_s, 0.0)), image(view.scan, Vector3d::Zero(), Workers(1)) {
    make_detection(view.scan, view.radial, rows_on(view, 0), SensorMotion{},
                   GroundHeights({Eigen::Matrix3d::Identity(), -kSensorHeight_m}), &image, detection);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
};

/// Takes in the next scan; the first one begins the filter.
void take_in(std::optional<BoxFilter>& filter, const Detection& detection, std::optional<double> yaw_rad,
             const TrackConfig& config) {
  if (filter) {
    filter->predict(kScanPeriod_s, config);
    filter->correct(detection, config);
  } else {
    filter.emplace(detection, yaw_rad, BoxHistory{}, config);
  }
}

MovingBox moving_body(double x, double y, double yaw, double speed, const Vector3d& size) {
  const Eigen::Matrix3d axes = upright_axes(yaw);
  return {{{x, y, 0.5 * size.z() - kSensorHeight_m}, axes, size}, speed * axes.col(0), 0.0};
}

/// A thing that stands between azimuths `from` and `to` (degrees), 8 m away, higher than all else.
MovingBox screen(double from, double to) {
  const double low = 8.0 * std::tan(from * std::numbers::pi / 180.0);
  const double high = 8.0 * std::tan(to * std::numbers::pi / 180.0);
  return {{{8.0, 0.5 * (low + high), 0.0}, Eigen::Matrix3d::Identity(), {0.1, high - low, 4.0}}, Vector3d::Zero(), 0.0};
}

TEST(BoxFilter, OfALorrySeenFromBehindTheLengthIsALikelyOne) {
  const TrackConfig config;
  const auto lorry = [](double t) { return moving_body(30 + 12 * t, 0, 0.0, 12, kLorry); };
  std::optional<BoxFilter> filter;
  for (int k = 0; k < 8; ++k) {
    const double t = k * kScanPeriod_s;
    const Scene scene({lorry(t)}, t);
    take_in(filter, scene.detection, 0.0, config);
    const BoxEstimate estimate = filter->estimate();
    EXPECT_EQ(view_of_face(estimate, Face::kFront), FaceView::kUnknown) << "scan " << k;
    EXPECT_EQ(view_of_face(estimate, Face::kRear), FaceView::kSeen) << "scan " << k;
    EXPECT_EQ(view_of_face(estimate, Face::kLeft), FaceView::kSeen) << "scan " << k;
    EXPECT_EQ(view_of_face(estimate, Face::kBottom), FaceView::kSeen) << "scan " << k;
    EXPECT_NEAR(middle_of(estimate.box, Face::kRear).x(), lorry(t).box.centre.x() - 5.0, 0.15) << "scan " << k;
    EXPECT_NEAR(estimate.box.size.x(), 10.0, 3.0) << "scan " << k;
    EXPECT_NEAR(estimate.box.size.y(), 2.4, 0.3) << "scan " << k;
    EXPECT_NEAR(estimate.box.size.z(), 3.0, 0.5) << "scan " << k;
    // And the covariance says how uncertain that makes the centre.
    EXPECT_GT(std::sqrt(estimate.centre_covariance(0, 0)), 0.3) << "scan " << k;
    EXPECT_LT(std::abs(estimate.box.centre.x() - lorry(t).box.centre.x()),
              3.0 * std::sqrt(estimate.centre_covariance(0, 0)))
        << "scan " << k;
    EXPECT_LT(filter->seen_box().size.x(), 1.0) << "that much was seen";
  }
}

TEST(BoxFilter, WhereTheTopIsAboveTheViewTheLengthIsMoreUncertain) {
  // The rear of the same lorry: up to its top, and to what would be the upper edge of the field of view.
  const TrackConfig config;
  const MovingBox lorry = moving_body(30, 0, 0.0, 12, kLorry);
  const auto share_of_length = [&](double highest_m) {
    View view = view_of({lorry}, 0.0, 0.0);
    std::vector<std::uint32_t> rows;
    for (const std::uint32_t row : rows_on(view, 0)) {
      if (view.scan.points()[row].z() <= highest_m) {
        rows.push_back(row);
      }
    }
    RawScan raw;
    raw.points.emplace_back(50.0, 10.0, highest_m);  // something behind it
    raw.doppler.push_back(0.0);
    for (std::size_t row = 0; row < view.scan.size(); ++row) {
      if (view.scan.points()[row].z() <= highest_m) {
        raw.points.push_back(view.scan.points()[row]);
        raw.doppler.push_back(0.0);
      }
    }
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    Detection detection;
    make_detection(view.scan, view.radial, rows, SensorMotion{},
                   GroundHeights({Eigen::Matrix3d::Identity(), -kSensorHeight_m}), &image, detection);
    const BoxEstimate estimate = BoxFilter(detection, 0.0, {}, config).estimate();
    return std::sqrt(estimate.centre_covariance(0, 0)) / estimate.box.size.x();
  };
  EXPECT_GT(share_of_length(0.5), 1.2 * share_of_length(10.0));
}

TEST(BoxFilter, WhatComesIntoViewChangesTheLengthAndNotTheMotion) {
  // A lorry comes out from behind a screen with its front first. The rear was never seen until the end of it.
  const TrackConfig config;
  const double yaw = 0.9;
  const auto lorry = [&](double t) {
    const Vector3d centre = Vector3d(22, -3, 0) + 8.0 * t * upright_axes(yaw).col(0);
    return moving_body(centre.x(), centre.y(), yaw, 8, kLorry);
  };
  std::optional<BoxFilter> filter;
  bool was_unknown = false;
  for (int k = 0; k < 20; ++k) {
    const double t = k * kScanPeriod_s;
    const Scene scene({lorry(t), screen(-40.0, -5.0)}, t);
    take_in(filter, scene.detection, yaw, config);
    const BoxEstimate estimate = filter->estimate();
    const OrientedBox truth = lorry(t).box;
    was_unknown = was_unknown || view_of_face(estimate, Face::kRear) == FaceView::kUnknown;
    const Vector3d end = middle_of(estimate.box, Face::kFront) - middle_of(truth, Face::kFront);
    EXPECT_NEAR(end.dot(truth.axes.col(0)), 0.0, 0.25) << "scan " << k;
    EXPECT_NEAR(filter->body().velocity().norm(), 8.0, k < 3 ? 1.0 : 0.4) << "scan " << k;
    EXPECT_LT(estimate.velocity.cross(truth.axes.col(0)).norm(), k < 3 ? 1.5 : 0.8) << "scan " << k;
  }
  const BoxEstimate estimate = filter->estimate();
  EXPECT_TRUE(was_unknown);
  EXPECT_EQ(view_of_face(estimate, Face::kRear), FaceView::kSeen);
  EXPECT_NEAR(estimate.box.size.x(), kLorry.x(), 0.3);
  EXPECT_LT((estimate.box.centre - lorry(1.9).box.centre).head<2>().norm(), 0.3);
}

TEST(BoxFilter, WhatSomethingNearerHidesStaysAsItWas) {
  // The lorry goes behind the screen with its front first.
  const TrackConfig config;
  const double yaw = 0.9;
  const auto lorry = [&](double t) {
    const Vector3d centre = Vector3d(22, -4, 0) + 8.0 * t * upright_axes(yaw).col(0);
    return moving_body(centre.x(), centre.y(), yaw, 8, kLorry);
  };
  std::optional<BoxFilter> filter;
  int hidden = 0;
  for (int k = 0; k < 14; ++k) {
    const double t = k * kScanPeriod_s;
    const Scene scene({lorry(t), screen(4.0, 45.0)}, t);
    take_in(filter, scene.detection, yaw, config);
    const BoxEstimate estimate = filter->estimate();
    const Vector3d front = middle_of(lorry(t).box, Face::kFront);
    const bool is_behind = std::atan2(front.y(), front.x()) > 6.0 * std::numbers::pi / 180.0;
    const bool is_before = std::atan2(front.y(), front.x()) < 1.0 * std::numbers::pi / 180.0;
    if (is_before) {
      EXPECT_EQ(view_of_face(estimate, Face::kFront), FaceView::kSeen) << "scan " << k;
    }
    if (is_behind) {
      ++hidden;
      EXPECT_EQ(view_of_face(estimate, Face::kFront), FaceView::kHidden) << "scan " << k;
      EXPECT_EQ(view_of_face(estimate, Face::kRear), FaceView::kSeen) << "scan " << k;
    }
    EXPECT_NEAR(estimate.box.size.x(), kLorry.x(), 0.5) << "scan " << k;
    EXPECT_LT((estimate.box.centre - lorry(t).box.centre).head<2>().norm(), 0.5) << "scan " << k;
    EXPECT_LT((estimate.velocity - lorry(t).velocity).norm(), k < 3 ? 2.0 : 0.8) << "scan " << k;
  }
  EXPECT_GE(hidden, 4);
}

TEST(BoxFilter, WhereABodyWasSeenToReachFartherItDoesNotEnd) {
  // The side of a lorry between two things that hide its ends; then only its foremost third, with nothing to be seen of
  // what hides the rest.
  const TrackConfig config;
  const Vector3d velocity(2.0, 0.0, 0.0);
  std::optional<BoxFilter> filter;
  for (int k = 0; k < 6; ++k) {
    const double front = 14.0 + velocity.x() * kScanPeriod_s * k;
    const bool is_framed = k < 4;
    RawScan raw;
    Detection detection;
    const auto add_side = [&](double from, double to) {
      for (double x = from; x <= to; x += 0.1) {
        for (double z = -1.0; z <= 1.5; z += 0.25) {
          detection.points.emplace_back(x, -8.0, z);
          detection.directions.push_back(detection.points.back().normalized());
          detection.radial.push_back(detection.directions.back().dot(velocity));
          detection.times.push_back(0.0);
        }
      }
    };
    const auto add_wall = [&](double from, double to, double y) {
      for (double x = from; x <= to; x += 0.02) {
        for (double z = -2.0; z <= 2.0; z += 0.1) {
          raw.points.emplace_back(x, y, z);
        }
      }
    };
    if (is_framed) {
      add_side(5.0, 13.0);
      add_wall(0.0, 3.0, -5.0);
      add_wall(8.2, 20.0, -5.0);
    } else {
      add_side(10.0, front);
    }
    add_wall(0.0, 60.0, -30.0);
    raw.points.insert(raw.points.end(), detection.points.begin(), detection.points.end());
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    detection.view = &image;
    take_in(filter, detection, 0.0, config);
  }
  EXPECT_GT(filter->seen_box().size.x(), 8.0) << "as much as was seen of it";
  EXPECT_NE(view_of_face(filter->estimate(), Face::kRear), FaceView::kSeen);
}

TEST(BoxFilter, PartsThatAddUpToMoreThanABodyAreForgotten) {
  // A car stands behind a gap that shows the middle of its side and neither end, and its Doppler says that it crosses
  // the gap. What is seen is never where the body should have gone: from scan to scan it seems to be a part of it
  // farther back. All parts together would be a body of 16 m whose middle is 7 m from the car.
  const TrackConfig config;
  const MovingBox car = moving_body(15, 0, 0.5 * std::numbers::pi, 0, {4.4, 1.8, 1.5});
  std::optional<BoxFilter> filter;
  double longest = 0.0;
  for (int k = 0; k < 40; ++k) {
    Scene scene({car, screen(-40.0, -4.0), screen(4.0, 45.0)}, k * kScanPeriod_s);
    const RandomSource random = RandomSource(8).fork(static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < scene.detection.radial.size(); ++i) {
      scene.detection.radial[i] = scene.detection.directions[i].dot(Vector3d(0.0, 4.0, 0.0)) + 0.05 * random.normal(i);
    }
    take_in(filter, scene.detection, 0.5 * std::numbers::pi, config);
    const BoxEstimate estimate = filter->estimate();
    ASSERT_EQ(view_of_face(estimate, Face::kFront), FaceView::kUnknown);
    ASSERT_EQ(view_of_face(estimate, Face::kRear), FaceView::kUnknown);
    EXPECT_LT(filter->seen_box().size.x(), 2.0 * car.box.size.x()) << "scan " << k;
    EXPECT_LT((estimate.box.centre - car.box.centre).head<2>().norm(), car.box.size.x()) << "scan " << k;
    longest = std::max(longest, filter->seen_box().size.x());
  }
  EXPECT_GT(longest, 1.2 * car.box.size.x()) << "parts do add up";
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
    MovingBox body = moving_body(20, 5, yaw, speed, {4.5, 1.8, 1.5});
    body.yaw_rate = 0.1 * random.normal(900);
    std::optional<BoxFilter> filter;
    for (std::uint64_t k = 0; k < 8; ++k) {
      if (filter) {
        constexpr int kSteps = 10;
        const double dt = kScanPeriod_s / kSteps;
        for (std::uint64_t i = 0; i < kSteps; ++i) {
          const RandomSource one = random.fork(1000 + 100 * k + i);
          speed += config.motion.along_mps * std::sqrt(dt) * one.normal(0);
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
  const MovingBox lorry = moving_body(0, -9, 0.0, 8, kLorry);
  Detection detection;
  for (int i = 0; i < 60; ++i) {
    const Vector3d point(4.0 + 0.5 * (i % 10) / 10.0, -9 + 0.5 * kLorry.y(), -1.0 + 0.25 * (i / 10));
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

TEST(BoxFilter, APersonIsNotThoughtToBeLonger) {
  const TrackConfig config;
  for (const std::optional<double> yaw : {std::optional<double>{}, std::optional<double>{0.3}}) {
    std::optional<BoxFilter> filter;
    for (int k = 0; k < 8; ++k) {
      const double t = k * kScanPeriod_s;
      const Scene scene({moving_body(12 + 1.4 * t, 1 + 0.4 * t, 0.3, 1.4, {0.5, 0.6, 1.7})}, t);
      take_in(filter, scene.detection, yaw, config);
      const BoxEstimate estimate = filter->estimate();
      EXPECT_LT(estimate.box.size.x(), 1.0) << "scan " << k;
      EXPECT_LT(estimate.box.size.y(), 1.0) << "scan " << k;
      EXPECT_NEAR(estimate.box.size.z(), 1.7, 0.3) << "scan " << k;
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
