// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// What a scan shows of a body, what it hides, and what is likely of the rest.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/tracking/box_filter.hpp"

#include "testing/filtered_box.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

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

/// A thing that stands between azimuths `from` and `to` (degrees), 8 m away, higher than all else.
MovingBox screen(double from, double to) {
  const double low = 8.0 * std::tan(from * std::numbers::pi / 180.0);
  const double high = 8.0 * std::tan(to * std::numbers::pi / 180.0);
  return {{{8.0, 0.5 * (low + high), 0.0}, Eigen::Matrix3d::Identity(), {0.1, high - low, 4.0}}, Vector3d::Zero(), 0.0};
}

TEST(BoxFilterView, OfALorrySeenFromBehindTheLengthIsALikelyOne) {
  const TrackConfig config;
  const auto lorry = [](double t) { return moving_body(30 + 12 * t, 0, 0.0, 12, kLorrySize_m); };
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
    // Nothing is seen above it: the field of view may end there, and vehicles are up to 4 m high.
    EXPECT_NEAR(estimate.box.size.z(), 0.5 * (3.0 + 4.0), 0.1) << "scan " << k;
    // And the covariance says how uncertain that makes the centre.
    EXPECT_GT(std::sqrt(estimate.centre_covariance(0, 0)), 0.3) << "scan " << k;
    EXPECT_LT(std::abs(estimate.box.centre.x() - lorry(t).box.centre.x()),
              3.0 * std::sqrt(estimate.centre_covariance(0, 0)))
        << "scan " << k;
    EXPECT_LT(filter->seen_box().size.x(), 1.0) << "that much was seen";
  }
}

TEST(BoxFilterView, WhereTheTopIsAboveTheViewTheLengthIsMoreUncertain) {
  // The rear of the same lorry: up to its top, and to what would be the upper edge of the field of view.
  const TrackConfig config;
  const MovingBox lorry = moving_body(30, 0, 0.0, 12, kLorrySize_m);
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

TEST(BoxFilterView, ALorryStaysAsHighAsItWasWhereOnlyItsCabinIsLeftInView) {
  // The sensor overtakes it. Its field of view ends 60 degrees to the right and 9.5 degrees up: the top of the load is
  // above that; the cabin, 3 m high, is not.
  constexpr double kGround_m = -1.8;
  constexpr double kBeside_m = -8.75;
  const double highest = std::tan(9.5 * std::numbers::pi / 180.0);
  const double rearmost = std::tan(30.0 * std::numbers::pi / 180.0);
  const TrackConfig config;
  const Vector3d velocity(2.7, 0.0, 0.0);
  std::optional<BoxFilter> filter;
  for (int k = 0; k < 14; ++k) {
    const Vector3d sensor = 2.0 * kScanPeriod_s * k * velocity;
    const double front = 9.0 + velocity.x() * kScanPeriod_s * k;
    RawScan raw;
    Detection detection;
    for (double x = sensor.x() - kBeside_m * rearmost; x <= front; x += 0.1) {
      const double edge = highest * std::hypot(x - sensor.x(), kBeside_m);
      for (double z = kGround_m + 1.0; z <= std::min(kGround_m + (x < front - 2.5 ? 3.6 : 3.0), edge); z += 0.05) {
        detection.points.emplace_back(x, kBeside_m, z);
        raw.points.push_back(detection.points.back() - sensor);
        detection.directions.push_back(raw.points.back().normalized());
        detection.radial.push_back(detection.directions.back().dot(velocity));
        detection.times.push_back(0.0);
      }
    }
    // What stands far away, up to the edge of the view.
    for (double azimuth = -1.05; azimuth < 1.05; azimuth += 0.005) {
      for (double up = 0.0; up <= 1.0; up += 0.03125) {
        raw.points.emplace_back(50.0 * std::cos(azimuth), 50.0 * std::sin(azimuth), 50.0 * highest * up);
      }
    }
    raw.doppler.assign(raw.points.size(), 0.0);
    const RangeImage image(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
    detection.view = &image;
    detection.sensor = sensor;
    detection.T_sensor_world.translation() = -sensor;
    detection.ground = {Eigen::Matrix3d::Identity(), kGround_m};
    take_in(filter, detection, 0.0, config);
    EXPECT_GT(filter->estimate().box.size.z(), 3.3) << "scan " << k;
  }
}

TEST(BoxFilterView, TwoEndsTellOfADisplacementOnce) {
  // A van seen almost from the side, from end to end, and 1.5 m farther in the next scan, while its Doppler, of which
  // little is believed, says half of that. Each end tells the whole displacement, and both together no more.
  constexpr double kFarther_m = 1.5;
  const Vector3d velocity_of_doppler(0, 5.0 * kFarther_m, 0);
  TrackConfig config;
  config.doppler_floor_mps = 1.0;
  const auto side = [&](double y, std::uint64_t seed) {
    Detection detection;
    for (std::uint64_t i = 0; i < 100; ++i) {
      const RandomSource one = RandomSource(seed).fork(i);
      detection.points.emplace_back(-40.0 + 0.02 * one.normal(0), y + one.uniform(1, 8.0, 13.0),
                                    one.uniform(2, -1.0, 1.0));
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity_of_doppler) + 0.1 * one.normal(3));
      detection.times.push_back(0.0);
    }
    return detection;
  };
  BoxFilter filter(side(0.0, 1), 0.5 * std::numbers::pi, {}, config);
  const double before = filter.body().position().y();
  filter.predict(0.1, config);
  filter.correct(side(kFarther_m, 2), config);
  EXPECT_LT(filter.body().position().y(), before + kFarther_m + 0.05);
  EXPECT_GT(filter.body().position().y(), before + kFarther_m - 0.2);
}

TEST(BoxFilterView, WhatComesIntoViewChangesTheLengthAndNotTheMotion) {
  // A lorry comes out from behind a screen with its front first. The rear was never seen until the end of it.
  const TrackConfig config;
  const double yaw = 0.9;
  const auto lorry = [&](double t) {
    const Vector3d centre = Vector3d(22, -3, 0) + 8.0 * t * upright_axes(yaw).col(0);
    return moving_body(centre.x(), centre.y(), yaw, 8, kLorrySize_m);
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
  EXPECT_NEAR(estimate.box.size.x(), kLorrySize_m.x(), 0.3);
  EXPECT_LT((estimate.box.centre - lorry(1.9).box.centre).head<2>().norm(), 0.3);
}

TEST(BoxFilterView, WhatSomethingNearerHidesStaysAsItWas) {
  // The lorry goes behind the screen with its front first.
  const TrackConfig config;
  const double yaw = 0.9;
  const auto lorry = [&](double t) {
    const Vector3d centre = Vector3d(22, -4, 0) + 8.0 * t * upright_axes(yaw).col(0);
    return moving_body(centre.x(), centre.y(), yaw, 8, kLorrySize_m);
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
    EXPECT_NEAR(estimate.box.size.x(), kLorrySize_m.x(), 0.5) << "scan " << k;
    EXPECT_LT((estimate.box.centre - lorry(t).box.centre).head<2>().norm(), 0.5) << "scan " << k;
    EXPECT_LT((estimate.velocity - lorry(t).velocity).norm(), k < 3 ? 2.0 : 0.8) << "scan " << k;
  }
  EXPECT_GE(hidden, 4);
}

/// A car that drives ahead, 25 m away, of which a wall hides all but roof and rear window.
Detection upper_part_of_car(double x, double speed_mps, RawScan& raw, std::optional<RangeImage>& image) {
  const Vector3d velocity(speed_mps, 0.0, 0.0);
  Detection detection;
  detection.ground.offset_m = -1.5;
  for (double y = -4.8; y <= -3.19; y += 0.1) {
    for (double z = -0.5; z <= 0.01; z += 0.1) {
      detection.points.emplace_back(x + z, y, z);
      detection.directions.push_back(detection.points.back().normalized());
      detection.radial.push_back(detection.directions.back().dot(velocity));
      detection.times.push_back(0.0);
    }
  }
  raw.points = detection.points;
  for (double y = -10.0; y <= 5.0; y += 0.02) {
    raw.points.emplace_back(60.0, 1.5 * y, 0.0);
    raw.points.emplace_back(60.0, 1.5 * y, 10.0);
    for (double z = -1.5; z < -0.34; z += 0.01) {
      raw.points.emplace_back(10.0, 0.5 * y, z);
    }
  }
  raw.doppler.assign(raw.points.size(), 0.0);
  image.emplace(Scan::from_raw(raw), Vector3d::Zero(), Workers(1));
  detection.view = &*image;
  return detection;
}

TEST(BoxFilterView, WhatIsSeenOverSomethingShowsThatItDoesNotCrossTheLineOfSight) {
  const TrackConfig config;
  std::optional<BoxFilter> ahead;
  std::optional<BoxFilter> crossing;
  for (int k = 0; k < 8; ++k) {
    RawScan raw;
    std::optional<RangeImage> image;
    const Detection detection = upper_part_of_car(25.0 + 0.8 * kScanPeriod_s * k, 0.8, raw, image);
    take_in(ahead, detection, 0.0, config);
    take_in(crossing, detection, -0.5 * std::numbers::pi, config);
  }
  EXPECT_GT(ahead->log_likelihood(), crossing->log_likelihood() + 10.0);
  EXPECT_LT((ahead->body().velocity() - Vector3d(0.8, 0.0, 0.0)).norm(), 0.3);
  const BoxEstimate estimate = ahead->estimate();
  EXPECT_EQ(view_of_face(estimate, Face::kLeft), FaceView::kUnknown) << "sides lean";
  EXPECT_NEAR(estimate.box.centre.y(), -4.0, 0.2);
}

TEST(BoxFilterView, ErrorsOfTheDopplerDoNotTurnWhatIsTooSlowToTurn) {
  // The front of a lorry beside the sensor, whose Doppler errs by 0.15 m/s over ten degrees, the same in all scans.
  const TrackConfig config;
  std::optional<BoxFilter> filter;
  for (int k = 0; k < 20; ++k) {
    const double t = k * kScanPeriod_s;
    Scene scene({moving_body(1.4 + 0.5 * t - 5.0, 3.0, 0.0, 0.5, kLorrySize_m)}, t);
    Detection& detection = scene.detection;
    for (std::size_t i = 0; i < detection.radial.size(); ++i) {
      const Vector3d& u = detection.directions[i];
      detection.radial[i] += 0.86 * (std::atan2(u.y(), u.x()) - 0.9);
    }
    take_in(filter, detection, 0.0, config);
  }
  EXPECT_LT(std::abs(filter->body().yaw()), 0.05);
  EXPECT_LT(std::abs(filter->body().yaw_rate()), 0.12);
}

TEST(BoxFilterView, WhereABodyWasSeenToReachFartherItDoesNotEnd) {
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

TEST(BoxFilterView, PartsThatAddUpToMoreThanABodyDoNotMoveSoFast) {
  // A car stands behind a gap that shows the middle of its side and neither end, and its Doppler says that it crosses
  // the gap. What is seen is never where the body should have gone: from scan to scan it seems to be a part of it
  // farther back. All parts together would be a body of 16 m whose middle is 7 m from the car. None is so long: what
  // holds still behind the gap stands, whatever the Doppler says.
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
  EXPECT_LT(filter->body().velocity().norm(), 2.0);
}

TEST(BoxFilterView, APersonIsNotThoughtToBeLonger) {
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
