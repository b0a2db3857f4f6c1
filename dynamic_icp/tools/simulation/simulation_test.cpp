// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/simulation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

SimulationConfig small_street() {
  SimulationConfig config = default_config(scenes::find_scene("street"));
  config.frames = 5;
  config.rig.sensors.front().lidar.columns = 150;
  config.rig.sensors.front().lidar.rows = 16;
  return config;
}

TEST(Simulation, BadKnobsAreUsageErrors) {
  const auto build = [](auto change) {
    SimulationConfig config = small_street();
    change(config);
    const Simulation simulation(scenes::find_scene("street"), config);
  };
  EXPECT_NO_THROW(build([](SimulationConfig&) {}));
  EXPECT_THROW(build([](SimulationConfig& c) { c.frames = 0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.scene.seed = -1; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.scene.speed_mps = -1.0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.scene.traffic = std::nan(""); }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.rig.sensors.front().lidar.rows = 0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.rig.sensors.front().mount.z_m = -1.0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.rig.sensors.front().lidar.min_range_m = 260.0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.rig.sensors.clear(); }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.rig.sensors.push_back(c.rig.sensors.front()); }), UsageError);
}

TEST(Simulation, SettingsAreOfTheDriveOfAllSensorsOrOfOne) {
  SimulationConfig config = small_street();
  config.rig.sensors.push_back(config.rig.sensors.front());
  config.rig.sensors[0].name = "left";
  config.rig.sensors[1].name = "right";
  set(config, "frames", "7");
  set(config, "lidar.rows", "9");
  set(config, "right.lidar.rows", "11");
  set(config, "mount.z_m", "1.5");
  EXPECT_EQ(config.frames, 7);
  EXPECT_EQ(config.rig.sensors[0].lidar.rows, 9);
  EXPECT_EQ(config.rig.sensors[1].lidar.rows, 11);
  EXPECT_EQ(config.rig.sensors[0].mount.z_m, 1.5);
  EXPECT_EQ(config.rig.sensors[1].mount.z_m, 1.5);
  EXPECT_THROW(set(config, "middle.lidar.rows", "11"), UsageError);
  EXPECT_THROW(set(config, "lidar.no_such_key", "11"), UsageError);
}

TEST(Simulation, EverySceneBearsTheLimitsOfItsKnobs) {
  const Workers workers(2);
  for (const scenes::SceneKind& kind : scenes::scene_kinds()) {
    for (const double speed : {0.0, 40.0}) {
      for (const double traffic : {0.0, 3.0}) {
        SimulationConfig config = small_street();
        config.frames = 1;
        config.scene.speed_mps = speed;
        config.scene.traffic = traffic;
        const Simulation simulation(kind, config);
        const SimulatedFrame frame = simulation.frame(0, workers);
        EXPECT_GT(frame.scan.bodies.size(), 500U) << kind.name;
        EXPECT_TRUE(frame.sensor.T_world_sensor.matrix().allFinite()) << kind.name;
        EXPECT_TRUE(frame.sensor.velocity_sensor.allFinite() && frame.sensor.angular_velocity_sensor.allFinite())
            << kind.name;
        if (traffic == 0.0) {
          EXPECT_TRUE(frame.objects.empty()) << kind.name;
        }
      }
    }
  }
}

TEST(Simulation, FramesDoNotDependOnEachOtherNorOnThreads) {
  const Simulation first(scenes::find_scene("street"), small_street());
  const Simulation second(scenes::find_scene("street"), small_street());
  (void)second.frame(0, Workers(2));
  for (const int threads : {1, 2, 7}) {
    const SimulatedFrame a = first.frame(3, Workers(1));
    const SimulatedFrame b = second.frame(3, Workers(threads));
    EXPECT_EQ(a.scan.measured.points, b.scan.measured.points);
    EXPECT_EQ(a.scan.measured.doppler, b.scan.measured.doppler);
    EXPECT_EQ(a.scan.bodies, b.scan.bodies);
    EXPECT_EQ(a.sensor.T_world_sensor.matrix(), b.sensor.T_world_sensor.matrix());
  }
}

TEST(Simulation, SeedChangesLayoutAndNoise) {
  SimulationConfig config = small_street();
  config.rig.sensors.front().lidar = without_noise(config.rig.sensors.front().lidar);
  const SimulatedFrame a = Simulation(scenes::find_scene("street"), config).frame(0, Workers(1));
  config.scene.seed = 2;
  const SimulatedFrame b = Simulation(scenes::find_scene("street"), config).frame(0, Workers(1));
  EXPECT_NE(a.scan.true_range, b.scan.true_range);
}

TEST(Simulation, StampsAreExactAtAwkwardRates) {
  SimulationConfig config = small_street();
  config.rig.sensors.front().lidar.rate_hz = 12.0;
  config.rig.sensors.front().lidar.sweep_s = 0.0;
  const Simulation simulation(scenes::find_scene("street"), config);
  EXPECT_EQ(simulation.stamp(0), Stamp{0});
  EXPECT_EQ(simulation.stamp(1), Stamp{83'333'333});
  EXPECT_EQ(simulation.stamp(12), Stamp{1'000'000'000});
}

TEST(Simulation, SensorsOfARigSeeTheSameWorldFromTheirMounts) {
  SimulationConfig config = small_street();
  SensorConfig second = config.rig.sensors.front();
  second.name = "second";
  second.mount = {-1.0, -0.7, 2.2, 0.0, 3.0, 170.0};
  config.rig.sensors.push_back(second);
  const Simulation simulation(scenes::find_scene("street"), config);
  const SimulatedFrame a = simulation.frame(2, Workers(1), 0);
  const SimulatedFrame b = simulation.frame(2, Workers(1), 1);
  const auto T_vehicle_world = [&](const SimulatedFrame& frame, const MountConfig& mount) {
    return T_vehicle_sensor(mount) * frame.sensor.T_world_sensor.inverse();
  };
  EXPECT_TRUE(
      T_vehicle_world(a, config.rig.sensors[0].mount).isApprox(T_vehicle_world(b, config.rig.sensors[1].mount), 1e-12));
  EXPECT_EQ(a.scan.measured.stamp, b.scan.measured.stamp);
  EXPECT_NE(a.scan.true_range, b.scan.true_range);
}

TEST(Simulation, VibrationIsInTruthAndDoppler) {
  SimulationConfig config = small_street();
  config.rig.sensors.front().lidar = without_noise(config.rig.sensors.front().lidar);
  const Simulation still(scenes::find_scene("street"), config);
  config.rig.vibration.wheel = {7.0, 13.0, 1.5, 0.03};
  const Simulation shaken(scenes::find_scene("street"), config);
  Statistics up;
  for (double t = 0.0; t < 40.0; t += 0.01) {
    const Eigen::Isometry3d moved = still.sensor()(t).T_world_body.inverse() * shaken.sensor()(t).T_world_body;
    up.add(moved.translation().z());
  }
  EXPECT_NEAR(1e3 * up.deviation(), 1.5 / std::sqrt(2.0), 0.03);
  const SimulatedFrame frame = shaken.frame(3, Workers(1));
  for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
    const double time_s = seconds_between(Stamp{}, frame.begin) + frame.scan.measured.times[i];
    if (frame.scan.bodies[i] == 0) {
      const Vector3d velocity_sensor = shaken.sensor_state(time_s).velocity_sensor;
      EXPECT_NEAR(frame.scan.measured.doppler[i], -frame.scan.measured.points[i].normalized().dot(velocity_sensor),
                  1e-9);
    }
  }
}

TEST(Simulation, SensorsOfARigShakeAsOneBody) {
  SimulationConfig config = small_street();
  SensorConfig second = config.rig.sensors.front();
  second.name = "second";
  second.mount = {-1.0, -0.7, 2.2, 0.0, 3.0, 170.0};
  config.rig.sensors.push_back(second);
  config.rig.vibration.engine = {20.0, 30.0, 2.0, 0.5};
  const Simulation simulation(scenes::find_scene("street"), config);
  const auto T_first_second = [&](double t) {
    return simulation.sensor(0)(t).T_world_body.inverse() * simulation.sensor(1)(t).T_world_body;
  };
  for (double t = 0.0; t < 1.0; t += 0.013) {
    EXPECT_TRUE(T_first_second(t).isApprox(T_first_second(0.0), 1e-12));
    const Eigen::Isometry3d T_vehicle =
        simulation.sensor(0)(t).T_world_body * T_vehicle_sensor(config.rig.sensors[0].mount).inverse();
    EXPECT_TRUE(simulation.scene().vehicle(t).T_world_body.isApprox(T_vehicle, 1e-12)) << "poses of the vehicle, too";
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
