// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/support_velocity.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace dynamic_icp::ego_motion {
namespace {

using Eigen::Vector3d;

constexpr double kRoadNoise_mps = 0.14;
constexpr double kOffRoad_mps = 0.6;

/// A road before the sensor, in a view of 120 degrees, and boxes beside it.
struct RoadScene {
  Vector3d velocity;  // m/s, of the sensor
  EgoVelocity ego;    // as far as it is known
  DopplerRows rows;
  Vector3d road_normal = Vector3d::UnitZ();
  std::mt19937 random{3};

  explicit RoadScene(const Vector3d& true_velocity = {5.0, 0.1, 0.05}) : velocity(true_velocity) {
    ego.velocity_sensor = velocity;
    ego.acceleration_sensor << 1.0, 0.5, 0.0;
    ego.bias_mps = 0.1;
    rows.first.push_back(0);
  }

  /// Points around a place (m, sensor axes) whose Doppler is that of static ones and `off_mps` more.
  void add_cell(const Vector3d& place, bool is_on_support, std::size_t points, double off_mps) {
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < points; ++k) {
      const Vector3d u = (place + 0.5 * Vector3d(normal(random), normal(random), 0.0)).normalized();
      const double dt = 0.05 * std::sin(static_cast<double>(k));
      rows.ux.push_back(u.x());
      rows.uy.push_back(u.y());
      rows.uz.push_back(u.z());
      rows.dt.push_back(dt);
      rows.s.push_back(-u.dot(velocity + dt * ego.acceleration_sensor) + ego.bias_mps + off_mps +
                       kRoadNoise_mps * normal(random));
    }
    rows.first.push_back(static_cast<std::uint32_t>(rows.s.size()));
    rows.sector.push_back(static_cast<std::uint32_t>(rows.cells()));
    rows.range.push_back(place.norm());
    rows.on_support.push_back(is_on_support ? 1 : 0);
  }

  /// Every `creeping`-th cell of the road belongs to something that creeps.
  void add_road(std::size_t creeping = 1000, double error_mps = 0.0) {
    std::normal_distribution<double> normal;
    std::size_t count = 0;
    for (double x = 6.0; x < 30.0; x += 4.0) {
      for (double y = -x; y <= x; y += 4.0) {
        add_cell({x, y, -1.9}, true, 60, ++count % creeping == 0 ? 0.8 : error_mps * normal(random));
      }
    }
  }

  [[nodiscard]] Vector3d off() const {
    return support_velocity(rows, ego, road_normal, kRoadNoise_mps, kOffRoad_mps) - velocity;
  }
};

TEST(SupportVelocity, IsThatOfTheRoadWhateverStandsBesideIt) {
  for (const double wrong_mps : {-0.5, 0.0, 0.5}) {
    RoadScene scene;
    scene.add_road();
    for (double y = 3.0; y < 8.0; y += 1.0) {
      scene.add_cell({8.0, y, 0.0}, false, 2000, 0.7);  // a van that creeps fills most of the view
    }
    scene.ego.velocity_sensor.x() += wrong_mps;
    EXPECT_LT(scene.off().head<2>().norm(), 0.03) << wrong_mps;
    EXPECT_LT(std::abs(scene.off().z()), 0.15) << "hardly seen on a road";
  }
}

TEST(SupportVelocity, IsNotPulledByWhatCreepsOnTheRoad) {
  RoadScene scene;
  scene.add_road(5);
  scene.ego.velocity_sensor.x() -= 0.2;
  EXPECT_LT(scene.off().head<2>().norm(), 0.05);
}

TEST(SupportVelocity, OfASensorThatErrsIsTheMeanOfTheRoad) {
  RoadScene scene;
  scene.add_road(1000, 0.1);
  scene.ego.velocity_sensor += Vector3d(-0.4, 0.3, 0.0);
  EXPECT_LT(scene.off().head<2>().norm(), 0.1);
}

TEST(SupportVelocity, LiesInTheRoad) {
  // A sensor that errs in every cell, and a velocity that boxes above the road and the road together have bent upwards:
  // from before the sensor the road hardly tells climbing from driving faster.
  RoadScene scene;
  scene.add_road(1000, 0.1);
  scene.ego.velocity_sensor += Vector3d(-0.5, 0.0, -3.0);
  EXPECT_LT(scene.off().head<2>().norm(), 0.1);
  EXPECT_LT(std::abs(scene.off().z()), 0.3);
}

TEST(SupportVelocity, ForgivesThatTheNormalIsWrong) {
  RoadScene scene({30.0, 0.1, 0.05});
  scene.add_road();
  scene.road_normal = Vector3d(0.1, 0.0, 1.0).normalized();
  EXPECT_LT(scene.off().head<2>().norm(), 0.03);
  EXPECT_LT(std::abs(scene.off().z()), 0.1);
}

TEST(SupportVelocity, KeepsWhatTheRoadDoesNotShow) {
  RoadScene scene;
  for (int k = 0; k < 40; ++k) {
    scene.add_cell({5.0 + k, 0.0, -1.9}, true, 60, 0.0);  // straight ahead
  }
  scene.ego.velocity_sensor += Vector3d(-0.3, 0.4, 0.0);
  EXPECT_NEAR(scene.off().x(), 0.0, 0.03);
  EXPECT_NEAR(scene.off().y(), 0.4, 0.05);
}

TEST(SupportVelocity, IsTheOneKnownWhereNoRoadIsSeen) {
  RoadScene scene;
  scene.add_road();
  scene.ego.velocity_sensor << 1.0, 2.0, 3.0;
  scene.rows.on_support.clear();
  EXPECT_EQ(support_velocity(scene.rows, scene.ego, scene.road_normal, kRoadNoise_mps, kOffRoad_mps),
            scene.ego.velocity_sensor);
  scene.rows.on_support.assign(scene.rows.cells(), 0);
  for (std::size_t cell = 0; cell < 19; ++cell) {
    scene.rows.on_support[cell] = 1;
  }
  EXPECT_EQ(support_velocity(scene.rows, scene.ego, scene.road_normal, kRoadNoise_mps, kOffRoad_mps),
            scene.ego.velocity_sensor);
  EXPECT_EQ(support_velocity({}, scene.ego, scene.road_normal, kRoadNoise_mps, kOffRoad_mps),
            scene.ego.velocity_sensor);
}

}  // namespace
}  // namespace dynamic_icp::ego_motion
