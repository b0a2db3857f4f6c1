// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/false_returns.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

TEST(FalseReturns, WindowIsNearAndMovesWithTheSensor) {
  Room room;
  room.config.window_rate = 0.1;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  double found = 0.0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    if (scan.kinds[i] == ReturnKind::kWindow) {
      EXPECT_TRUE(scan.true_range[i] >= 0.1 && scan.true_range[i] < 0.5);
      EXPECT_EQ(scan.measured.doppler[i], 0.0);
      EXPECT_EQ(scan.bodies[i], kNoBody);
      found += 1.0;
    }
  }
  EXPECT_NEAR(found / (120.0 * 16.0), 0.1, share_error(0.1, 120.0 * 16.0));
}

TEST(FalseReturns, GhostsOfAWorldAtRestStayWhereTheyAre) {
  Room room;
  room.world.bodies.clear();
  room.config.multipath_rate = 0.25;
  const double t = 0.3;
  const SimulatedScan scan = room.scan(scan_pattern(room.config));
  double found = 0.0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const Vector3d point_world = room.sensor(t).T_world_body * scan.measured.points[i];
    const double beyond = (point_world.cwiseAbs() - Vector3d(30.0, 25.0, 10.0)).maxCoeff();
    EXPECT_EQ(scan.kinds[i] == ReturnKind::kGhost, beyond > 1e-6) << "behind a wall of the room";
    if (scan.kinds[i] == ReturnKind::kGhost) {
      const double h = 1e-5;
      const auto distance = [&](double time) {
        return (point_world - room.sensor(time).T_world_body.translation()).norm();
      };
      EXPECT_NEAR(scan.measured.doppler[i], (distance(t + h) - distance(t - h)) / (2.0 * h), 1e-6);
      EXPECT_EQ(scan.bodies[i], kNoBody);
      found += 1.0;
    }
  }
  EXPECT_NEAR(found / 1920.0, 0.25, share_error(0.25, 1920.0));
}

TEST(FalseReturns, GhostInAMovingMirrorIsTwiceAsFast) {
  Wall wall(-10.1, 0.3);  // behind the sensor
  world::add_shape(wall.world, world::make_box({0.2, 50.0, 50.0}));
  world::add_body(wall.world, "mirror", 0, [](double t) {
    world::MotionState state;
    state.T_world_body.translation().x() = 20.1 - 2.0 * t;
    state.velocity_world.x() = -2.0;
    return state;
  });
  wall.caster = std::make_unique<world::RayCaster>(wall.world);
  wall.config.multipath_rate = 1.0;
  const SimulatedScan scan = wall.scan();
  ASSERT_EQ(scan.bodies.size(), 20000U);
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    const Vector3d u = scan.measured.points[i].normalized();
    EXPECT_NEAR(scan.measured.points[i].x(), 20.0 + 30.0, 1e-9);  // the wall at -10 seen in the mirror at 20
    EXPECT_NEAR(scan.measured.doppler[i], -4.0 * u.x(), 1e-9);
  }
}

TEST(FalseReturns, SprayFollowsFastBodies) {
  Wall wall(200.1, 0.3);
  world::add_shape(wall.world, world::make_box({4.0, 2.0, 2.0}));
  double speed_mps = 20.0;
  world::add_body(wall.world, "car", 0, [&](double t) {
    world::MotionState state;
    state.T_world_body.translation() << 30.0 + speed_mps * t, 0.0, 0.0;
    state.velocity_world.x() = speed_mps;
    return state;
  });
  wall.caster = std::make_unique<world::RayCaster>(wall.world);
  wall.config.spray_rate = 0.3;
  const SimulatedScan scan = wall.scan();
  double found = 0.0;
  for (std::size_t i = 0; i < scan.bodies.size(); ++i) {
    if (scan.kinds[i] == ReturnKind::kSpray) {
      const Vector3d& p = scan.measured.points[i];
      EXPECT_TRUE(p.x() > 20.0 && p.x() < 28.0 && std::abs(p.y()) < 1.0) << p.transpose();
      const double expected = 0.6 * 20.0 * std::exp(-(28.0 - p.x()) / 5.0);
      EXPECT_NEAR(scan.true_doppler[i], expected, 6.0 * 0.5 + 0.01);
      EXPECT_EQ(scan.bodies[i], kNoBody);
      found += 1.0;
    }
  }
  // The view of one degree is less than a metre wide and high there: every ray crosses the cloud.
  EXPECT_NEAR(found / 20000.0, 0.3, share_error(0.3, 20000.0));
  speed_mps = 4.0;
  const SimulatedScan slow = wall.scan();
  EXPECT_EQ(std::count(slow.kinds.begin(), slow.kinds.end(), ReturnKind::kSpray), 0);
}

}  // namespace
}  // namespace dynamic_icp::simulation
