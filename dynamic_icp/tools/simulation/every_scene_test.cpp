// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"

namespace dynamic_icp::simulation {
namespace {

using Eigen::Vector3d;

/// Every scene without noise, from a sensor that sits far off the middle, looks askew and sweeps.
class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static SimulationConfig config() {
    SimulationConfig config = default_config(scenes::find_scene(GetParam()));
    config.frames = 45;
    SensorConfig& sensor = config.rig.sensors.front();
    sensor.lidar = without_noise(sensor.lidar);
    sensor.lidar.columns = 300;
    sensor.lidar.rows = 32;
    sensor.mount = {1.8, 0.6, 2.0, 5.0, 4.0, -8.0};
    return config;
  }

  /// Time of a point on the clock of the trajectories.
  [[nodiscard]] double time_of(const SimulatedFrame& frame, std::size_t point) const {
    return seconds_between(Stamp{}, simulation_.stamp(frame.index)) + frame.scan.measured.times[point];
  }

  const Simulation simulation_{scenes::find_scene(GetParam()), config()};
  const Workers workers_{2};
};

/// Velocity of a material point of a moving frame, by moving the frame and not by its twist.
Vector3d finite_velocity(const world::Trajectory& trajectory, double t, const Vector3d& point_world) {
  const double h = 1e-5;
  const Vector3d point_body = trajectory(t).T_world_body.inverse() * point_world;
  return (trajectory(t + h).T_world_body * point_body - trajectory(t - h).T_world_body * point_body) / (2.0 * h);
}

TEST_P(EveryScene, DopplerObeysTheVelocityFields) {
  for (const std::size_t index : {0U, 21U, 44U}) {
    const SimulatedFrame frame = simulation_.frame(index, workers_);
    ASSERT_GT(frame.scan.bodies.size(), 3000U);
    for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
      const double t = time_of(frame, i);
      const Eigen::Isometry3d T = simulation_.sensor()(t).T_world_body;
      const Vector3d v_world = finite_velocity(simulation_.sensor(), t, T.translation());
      const Vector3d& p = frame.scan.measured.points[i];
      const double s = frame.scan.measured.doppler[i];
      if (frame.scan.bodies[i] == 0) {
        ASSERT_LT(std::abs(s + p.normalized().dot(T.linear().transpose() * v_world)), 1e-4);
      } else {
        const auto body = static_cast<std::size_t>(frame.scan.bodies[i] - 1);
        const Vector3d v_point = finite_velocity(simulation_.scene().world.bodies[body].trajectory, t, T * p);
        ASSERT_LT(std::abs(s - (T.linear() * p).normalized().dot(v_point - v_world)), 1e-4);
      }
    }
  }
}

TEST_P(EveryScene, StaticPointsOfOneScanLieOnTheSurfacesSeenFromTheNext) {
  for (const std::size_t index : {3U, 33U}) {
    const SimulatedFrame frame = simulation_.frame(index, workers_);
    const SimulatedFrame next = simulation_.frame(index + 1, workers_);
    const Eigen::Isometry3d T_next_world = next.sensor.T_world_sensor.inverse();
    std::vector<double> distances;
    std::size_t floating = 0;
    for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
      if (frame.scan.bodies[i] != 0) {
        continue;
      }
      // Deskewed by the true pose of the point's own time.
      const Eigen::Isometry3d T_world_sensor = simulation_.sensor()(time_of(frame, i)).T_world_body;
      const Vector3d p = T_next_world * T_world_sensor * frame.scan.measured.points[i];
      const world::Ray ray{next.sensor.T_world_sensor.translation(),
                           next.sensor.T_world_sensor.linear() * p.normalized(), 300.0};
      const auto hit = simulation_.caster().cast(ray, {});
      const double beyond = hit ? hit->range_m - p.norm() : 1e9;
      floating += beyond > 1e-3 ? 1 : 0;  // nothing there; nearer is something that hides the point now
      distances.push_back(hit ? std::abs(beyond * hit->normal_world.dot(ray.direction_world)) : 1e9);
    }
    auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    EXPECT_LT(*middle, 1e-6);
    const auto seen = std::count_if(distances.begin(), distances.end(), [](double d) { return d < 1e-3; });
    EXPECT_GT(static_cast<double>(seen), 0.8 * static_cast<double>(distances.size()));
    EXPECT_LE(static_cast<double>(floating), 1e-3 * static_cast<double>(seen));
  }
}

TEST_P(EveryScene, PosesAreTheIntegralOfTheTwist) {
  // Runge and Kutta's rule over the twists alone must carry the sensor from one scan to a later one.
  const world::Trajectory& sensor = simulation_.sensor();
  Eigen::Isometry3d T = sensor(0.0).T_world_body;
  const int steps = 4000;
  const double dt = 4.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const world::MotionState middle = sensor((i + 0.5) * dt);
    T.translation() += dt * middle.velocity_world;
    T.linear() = exp_so3(dt * middle.angular_velocity_world) * T.linear();
  }
  const Eigen::Isometry3d expected = sensor(4.0).T_world_body;
  EXPECT_LT((T.translation() - expected.translation()).norm(), 1e-4);
  EXPECT_LT(rotation_angle(T.linear().transpose() * expected.linear()), 1e-5);
}

TEST_P(EveryScene, SpeedIsTheOneAskedFor) {
  const int steps = 140;  // 14 s: two waves of the traffic jam
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    sum += simulation_.scene().vehicle(0.1 * i).velocity_world.head<2>().norm() / steps;
  }
  const double asked = simulation_.kind().speed_mps;
  EXPECT_NEAR(sum, asked, 0.25 * asked + 1e-12);
}

TEST_P(EveryScene, ObjectsAreToldInTheSensorFrame) {
  const SimulatedFrame frame = simulation_.frame(20, workers_);
  std::size_t counted = 0;
  for (const ObjectTruth& object : frame.objects) {
    const world::Trajectory& trajectory =
        simulation_.scene().world.bodies[static_cast<std::size_t>(object.id - 1)].trajectory;
    const Vector3d center_world = frame.sensor.T_world_sensor * object.center_sensor;
    EXPECT_LT(
        (frame.sensor.T_world_sensor.linear() * object.velocity_sensor - finite_velocity(trajectory, 2.0, center_world))
            .norm(),
        1e-5);
    const auto points = std::count(frame.scan.bodies.begin(), frame.scan.bodies.end(), object.id);
    EXPECT_EQ(static_cast<std::ptrdiff_t>(object.points), points);
    counted += object.points;
    for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
      if (frame.scan.bodies[i] == object.id) {
        // Into the body's frame with both poses at the point's own time.
        const double t = time_of(frame, i);
        const Vector3d p_body =
            trajectory(t).T_world_body.inverse() * simulation_.sensor()(t).T_world_body * frame.scan.measured.points[i];
        const Vector3d center_body = object.T_sensor_body.inverse() * object.center_sensor;
        ASSERT_LE(((p_body - center_body).cwiseAbs() - 0.5 * object.size).maxCoeff(), 1e-6);
      }
    }
  }
  EXPECT_LE(counted, frame.scan.bodies.size());
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const scenes::SceneKind& kind : scenes::scene_kinds()) {
    names.emplace_back(kind.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(, EveryScene, testing::ValuesIn(scene_names()),
                         [](const testing::TestParamInfo<std::string>& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Street, CarsAheadAndOncomingAreSeenForMostOfTheDrive) {
  SimulationConfig config = default_config(scenes::find_scene("street"));
  config.rig.sensors.front().lidar.columns = 600;
  const Simulation simulation(scenes::find_scene("street"), config);
  const Workers workers(2);
  int ahead = 0;
  int oncoming = 0;
  for (std::size_t i = 0; i < simulation.size(); i += 5) {
    const SimulatedFrame frame = simulation.frame(i, workers);
    const auto seen = [&](double sign) {
      return std::any_of(frame.objects.begin(), frame.objects.end(), [&](const ObjectTruth& object) {
        return sign * object.velocity_sensor.x() > 5.0 && object.points > 20;
      });
    };
    ahead += seen(1.0) ? 1 : 0;
    oncoming += seen(-1.0) ? 1 : 0;
  }
  EXPECT_GE(ahead, 10);
  EXPECT_GE(oncoming, 8);
}

TEST(Jam, MostOfWhatIsSeenMoves) {
  const scenes::SceneKind& kind = scenes::find_scene("traffic-jam");
  const Simulation simulation(kind, default_config(kind));
  const SimulatedFrame frame = simulation.frame(30, Workers(2));
  std::size_t moving = 0;
  for (const ObjectTruth& object : frame.objects) {
    moving += object.points;
  }
  EXPECT_GT(static_cast<double>(moving), 0.4 * static_cast<double>(frame.scan.bodies.size()));
}

}  // namespace
}  // namespace dynamic_icp::simulation
