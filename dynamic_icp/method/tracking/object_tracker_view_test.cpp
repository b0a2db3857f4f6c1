// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "dynamic_icp/method/tracking/object_tracker.hpp"

#include "testing/boxes_in_view.hpp"

namespace dynamic_icp::tracking {
namespace {

// What depends on how the sensor moves and on what hides what.

using Eigen::Vector3d;
using Objects = std::vector<TrackedObject>;

/// Driving 8 m/s in a circle, 0.3 rad/s, tilted by two degrees.
Eigen::Isometry3d turning_and_tilted(double t) {
  constexpr double kSpeed = 8.0;
  constexpr double kRotation_rad_s = 0.3;
  const double heading = 0.7 + kRotation_rad_s * t;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.0, 0.0, heading}) * exp_so3({0.03, -0.04, 0.0});
  T.translation() =
      kSpeed / kRotation_rad_s * Vector3d(std::sin(heading) - std::sin(0.7), std::cos(0.7) - std::cos(heading), 0);
  return T;
}

/// A box that stands.
MovingBox block(const Vector3d& centre, const Vector3d& size) {
  return {{centre, Eigen::Matrix3d::Identity(), size}, Vector3d::Zero(), 0.0};
}

TEST(ObjectTrackerView, WhatTheEdgeOfTheViewCutsOffInTheFirstScanIsNoEnd) {
  // A car to the left of a sensor at 10 m/s, which sees it at the end of its sweep, a metre from where that began.
  Viewing viewing;
  viewing.pose = [](double t) { return Eigen::Isometry3d(Eigen::Translation3d(10.0 * t, 0.0, 0.0)); };
  viewing.sweep_s = kScanPeriod_s;
  const Traffic traffic = [](double t) { return std::vector<MovingBox>{car(4.0 + 12.0 * t, 5.0, 0.0, 12.0)}; };
  ObjectTracker tracker{TrackerConfig{}};
  const Objects objects = step(tracker, view_of(traffic, 0.0, viewing), viewing.motion(0.0));
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].faces[index_of(Face::kRight)], FaceView::kSeen);
  EXPECT_NE(objects[0].faces[index_of(Face::kRear)], FaceView::kSeen);
}

TEST(ObjectTrackerView, ASensorThatMovesTurnsTiltsAndSweepsSeesTheTruth) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(14 + 5 * t, 13 + 5.5 * t, std::atan2(5.5, 5.0), std::hypot(5.5, 5.0))};
  };
  for (const double sweep : {0.0, kScanPeriod_s}) {
    ObjectTracker tracker{TrackerConfig{}};
    const Viewing viewing{turning_and_tilted, sweep};
    for (int k = 0; k < 20; ++k) {
      const double t = k * kScanPeriod_s;
      const View view = view_of(traffic, t, viewing);
      const Eigen::Isometry3d T_world_sensor = turning_and_tilted(t);
      const Objects objects = confirmed(step(tracker, view, viewing.motion(t)));
      if (k < 8) {
        continue;
      }
      ASSERT_EQ(objects.size(), 1u) << "scan " << k;
      const MovingBox truth = traffic(t)[0];
      const Vector3d velocity = T_world_sensor.linear().transpose() * truth.velocity;
      const Vector3d centre = T_world_sensor.inverse() * truth.box.centre;
      EXPECT_LT((objects[0].velocity_sensor - velocity).norm(), 0.1) << "scan " << k << " sweep " << sweep;
      // Rays meet the far end of its side half a metre apart, and its corner is sharper than those of cars: the length
      // is off by as much.
      EXPECT_LT((objects[0].centroid - centre).norm(), 0.25) << "scan " << k << " sweep " << sweep;
      EXPECT_LT((objects[0].box.axes.col(0) - velocity.normalized()).norm(), 0.03) << "scan " << k;
    }
  }
}

TEST(ObjectTrackerView, TellsBeforehandWhichPointsAreOfACarThatCrosses) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(20, -6 + 4.5 * t, 0.5 * std::numbers::pi, 4.5)};
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 24; ++k) {
    const View view = view_of(traffic, k * kScanPeriod_s, {.sweep_s = kScanPeriod_s});
    if (k >= 5) {
      std::vector<std::uint8_t> expected(view.scan.size(), 0);
      ScanPatches patches;
      patches.bound(view.scan, Workers(2));
      tracker.flag_expected(view.scan, patches, view.radial, SensorMotion{}, Workers(2), expected);
      std::size_t high = 0;  // where no ground is
      std::size_t of_car = 0;
      std::size_t others = 0;
      for (std::size_t row = 0; row < view.scan.size(); ++row) {
        const bool is_high = view.body[row] == 0 && view.scan.points()[row].z() > -1.1;
        high += is_high ? 1 : 0;
        of_car += is_high && expected[row] != 0 ? 1 : 0;
        others += view.body[row] != 0 && expected[row] != 0 ? 1 : 0;
      }
      EXPECT_GT(of_car, high * 19 / 20) << "scan " << k;
      EXPECT_LT(others, high / 50) << "scan " << k;
    }
    step(tracker, view);
  }
}

TEST(ObjectTrackerView, ACarOfWhichHardlyAnythingMovesAlongTheLineOfSightIsFollowed) {
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(30, -6 + 4.5 * t, 0.5 * std::numbers::pi, 4.5)};
  };
  ObjectTracker tracker{TrackerConfig{}};
  int nearly_still = 0;
  for (int k = 0; k < 24; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of(traffic(t), t);
    const Objects objects = confirmed(step(tracker, view));
    const std::vector<std::uint32_t> rows = rows_on(view, 0);
    const auto moving = std::count_if(rows.begin(), rows.end(), [&](auto row) { return view.is_moving[row] != 0; });
    if (static_cast<double>(moving) > 0.2 * static_cast<double>(rows.size())) {
      continue;
    }
    ++nearly_still;
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1);
    EXPECT_GT(objects[0].members.size(), rows.size() * 3 / 5) << "scan " << k;
    EXPECT_LT((objects[0].velocity_sensor - traffic(t)[0].velocity).norm(), 0.5) << "scan " << k;
    EXPECT_LT((objects[0].centroid - traffic(t)[0].box.centre).norm(), 0.4) << "scan " << k;
  }
  EXPECT_GE(nearly_still, 3);
}

TEST(ObjectTrackerView, AWallWhereACrossingCarShouldBeIsNotTheCar) {
  // It is gone when it has some radial velocity again. Of the wall in its place only a part fits that velocity.
  const auto traffic = [](double t) {
    return std::vector<MovingBox>{t < 1.85 ? car(30, -6 + 4.5 * t, 0.5 * std::numbers::pi, 4.5)
                                           : block({29.6, 3.0, -0.75}, {1, 12, 1.5})};
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 22; ++k) {
    const std::size_t cars = k * kScanPeriod_s < 1.85 ? 1 : 0;
    const Objects objects = confirmed(step(tracker, view_of(traffic(k * kScanPeriod_s), k * kScanPeriod_s)));
    if (k >= 5) {
      EXPECT_EQ(objects.size(), cars) << "scan " << k;
    }
  }
}

TEST(ObjectTrackerView, PartsThatComeIntoViewAreNoMotion) {
  // Behind the edge of a wall most of the car is hidden at first: its rear end seems to stand there.
  const Traffic traffic = [](double t) {
    return std::vector<MovingBox>{car(20, 2.5 + 5 * t, 0.5 * std::numbers::pi, 5), block({10, -2, 0}, {1, 6.8, 3})};
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 12; ++k) {
    const double t = k * kScanPeriod_s;
    const View view = view_of(traffic(t), t);
    const Objects objects = confirmed(step(tracker, view));
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1);
    const MovingBox truth = traffic(t)[0];
    EXPECT_LT((objects[0].velocity_sensor - truth.velocity).norm(), 0.7) << "scan " << k;
    EXPECT_GT(objects[0].members.size(), rows_on(view, 0).size() * 4 / 5) << "scan " << k;
    // The front is where it is, however much of the rear is seen.
    const OrientedBox& box = objects[0].box;
    const Vector3d front = box.centre + 0.5 * box.size.x() * box.axes.col(0);
    EXPECT_NEAR(front.y(), truth.box.centre.y() + 2.2, 0.25) << "scan " << k;
  }
}

TEST(ObjectTrackerView, AFastCarInASlowSweepIsOne) {
  // It comes 2.5 m nearer from the first ray to the last.
  const Traffic traffic = [](double t) { return std::vector<MovingBox>{car(60 - 25 * t, 4, std::numbers::pi, 25)}; };
  ObjectTracker tracker{TrackerConfig{}};
  Viewing viewing;
  viewing.sweep_s = kScanPeriod_s;
  for (int k = 0; k < 16; ++k) {
    const View view = view_of(traffic, k * kScanPeriod_s, viewing);
    const Objects objects = step(tracker, view);
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1);
    EXPECT_GT(objects[0].members.size(), rows_on(view, 0).size() * 9 / 10) << "scan " << k;
  }
}

TEST(ObjectTrackerView, ASmallPartBesideABodyIsNoObjectOfItsOwn) {
  // Too far from the side of the car for a link between cells, but within the growth of its box. At first sight, with
  // other noise each time.
  MovingBox part = block({12.9, -1.2, -0.7}, {0.2, 0.2, 1.0});
  part.velocity = {8, 0, 0};
  for (int k = 0; k < 8; ++k) {
    const View view = view_of({car(15, -3, 0.0, 8), part}, k * kScanPeriod_s);
    ASSERT_GE(rows_on(view, 1).size(), 10u) << "enough for an object";
    ObjectTracker tracker{TrackerConfig{}};
    EXPECT_EQ(step(tracker, view).size(), 1u) << "noise " << k;
  }
}

TEST(ObjectTrackerView, PointsThatSeemToMoveAmongMoreThatStandAreNoObject) {
  // Every third point of a wall of 2 x 2 m has the Doppler of one rigid body.
  for (const std::uint32_t every : {1u, 3u}) {
    View view = view_of({block({15, 0, 0}, {0.5, 2, 2})}, 0.0, 0.0);
    std::uint32_t points = 0;
    for (const std::uint32_t row : rows_on(view, 0)) {
      if (points++ % every == 0) {
        view.radial[row] = view.scan.directions()[row].dot(Vector3d(5, 1, 0));
        view.is_moving[row] = 1;
      }
    }
    ASSERT_GT(points, 200u);
    ObjectTracker tracker{TrackerConfig{}};
    EXPECT_EQ(step(tracker, view).size(), every == 1 ? 1u : 0u) << "every " << every;
  }
}

/// A tractor with its trailer that comes head-on: cab and trailer.
std::vector<MovingBox> tractor_with_trailer(double t) {
  const double front = 34.0 - 5.0 * t;
  const Eigen::Matrix3d axes = upright_axes(std::numbers::pi);
  const Vector3d velocity(-5.0, 0.0, 0.0);
  return {{{{front + 1.2, 6.0, 0.3}, axes, {2.4, 2.5, 3.6}}, velocity, 0.0},
          {{{front + 9.8, 6.0, 0.9}, axes, {13.6, 2.5, 3.2}}, velocity, 0.0}};
}

TEST(ObjectTrackerView, WhatComesHeadOnIsAsLongAsTheEndOfItsSideSays) {
  // Of the side the sensor sees single columns of points, far apart.
  ObjectTracker tracker{TrackerConfig{}};
  Objects objects;
  for (int k = 0; k < 5; ++k) {
    objects = confirmed(step(tracker, view_of(tractor_with_trailer, k * kScanPeriod_s, {})));
    ASSERT_EQ(objects.size(), 1u) << "scan " << k;
    EXPECT_EQ(objects[0].id, 1) << "scan " << k;
  }
  EXPECT_NEAR(objects[0].box.size.x(), 16.6, 1.5);
}

TEST(ObjectTrackerView, WhatIsLongerThanOneBodyIsTwoOnceTheGapIsSeen) {
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 50; ++k) {
    const double t = k * kScanPeriod_s;
    const Objects objects = confirmed(step(tracker, view_of(tractor_with_trailer, t, {})));
    if (k < 40) {
      continue;  // from 14 m on columns of points are closer than the gap of 0.6 m is wide
    }
    ASSERT_EQ(objects.size(), 2u) << "scan " << k;
    const MovingBox trailer = tractor_with_trailer(t)[1];
    EXPECT_LT((objects[1].box.centre - trailer.box.centre).head<2>().norm(), 0.5) << "scan " << k;
    EXPECT_NEAR(objects[1].box.size.x(), 13.6, 0.7) << "scan " << k;
    EXPECT_EQ(objects[1].divided_from, objects[0].id);
    for (const TrackedObject& object : objects) {
      EXPECT_LT((object.velocity_sensor - trailer.velocity).norm(), 0.5) << "scan " << k;
    }
  }
}

/// A lorry and its trailer that come towards the sensor beside its way, for 1.5 s. The rear of the lorry and all of the
/// trailer are seen at small angles.
std::vector<MovingBox> lorry_and_trailer(double t) {
  const double front = 13.0 - 5.0 * t;
  const Eigen::Matrix3d axes = upright_axes(std::numbers::pi);
  const Vector3d velocity(-5.0, 0.0, 0.0);
  return {{{{front + 5.0, 8.0, 0.3}, axes, {10.0, 2.5, 3.6}}, velocity, 0.0},
          {{{front + 15.0, 8.0, 0.3}, axes, {7.4, 2.5, 3.6}}, velocity, 0.0}};
}

void expect_lorry_and_trailer(const Objects& objects, int scan) {
  ASSERT_EQ(objects.size(), 2u) << "scan " << scan;
  for (const MovingBox& body : lorry_and_trailer(scan * kScanPeriod_s)) {
    const OrientedBox& box = nearest(objects, body.box.centre).box;
    EXPECT_LT((box.centre - body.box.centre).head<2>().norm(), 0.5) << "scan " << scan;
    EXPECT_NEAR(box.size.x(), body.box.size.x(), 1.0) << "scan " << scan;
  }
}

TEST(ObjectTrackerView, ALorryAndItsTrailerShareNeitherPointsNorPlace) {
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = -10; k < 15; ++k) {
    const Objects objects = confirmed(step(tracker, view_of(lorry_and_trailer, k * kScanPeriod_s, {})));
    if (k >= 0) {
      expect_lorry_and_trailer(objects, k);
    }
  }
}

TEST(ObjectTrackerView, ATrailerGivesBackWhatWasTakenForAPartOfIt) {
  // At first a screen hides the lorry but for its last metre, and the gap behind it cannot be seen.
  const Traffic behind_screen = [](double t) {
    std::vector<MovingBox> all = lorry_and_trailer(t);
    if (t < 0.45) {
      all.push_back(block({6.0, 3.6, 0.5}, {0.2, 3.4, 5.0}));
      OrientedBox& trailer = all[1].box;
      trailer.size.x() += 2.0;
      trailer.centre.x() -= 1.0;
    }
    return all;
  };
  ObjectTracker tracker{TrackerConfig{}};
  for (int k = 0; k < 15; ++k) {
    const Objects objects = confirmed(step(tracker, view_of(behind_screen, k * kScanPeriod_s, {})));
    if (k >= 8) {
      expect_lorry_and_trailer(objects, k);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::tracking
