// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

SimulationConfig small_street() {
  SimulationConfig config = default_config(find_scene("street"));
  config.frames = 5;
  config.lidar.columns = 150;
  config.lidar.rows = 16;
  return config;
}

TEST(Simulation, BadKnobsAreUsageErrors) {
  const auto build = [](auto change) {
    SimulationConfig config = small_street();
    change(config);
    const Simulation simulation(find_scene("street"), config);
  };
  EXPECT_NO_THROW(build([](SimulationConfig&) {}));
  EXPECT_THROW(build([](SimulationConfig& c) { c.frames = 0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.seed = -1; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.speed_mps = -1.0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.traffic = std::nan(""); }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.lidar.rows = 0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.mount.z_m = -1.0; }), UsageError);
  EXPECT_THROW(build([](SimulationConfig& c) { c.lidar.min_range_m = c.lidar.max_range_m = 50.0; }), UsageError);
}

TEST(Simulation, EverySceneBearsTheLimitsOfItsKnobs) {
  const Workers workers(2);
  for (const SceneKind& kind : scene_kinds()) {
    for (const double speed : {0.0, 40.0}) {
      for (const double traffic : {0.0, 3.0}) {
        SimulationConfig config = small_street();
        config.frames = 1;
        config.speed_mps = speed;
        config.traffic = traffic;
        const Simulation simulation(kind, config);
        const SimulatedFrame frame = simulation.frame(0, workers);
        EXPECT_GT(frame.scan.bodies.size(), 500U) << kind.name;
        EXPECT_TRUE(frame.T_world_sensor.matrix().allFinite()) << kind.name;
        EXPECT_TRUE(frame.velocity_sensor.allFinite() && frame.angular_velocity_sensor.allFinite()) << kind.name;
        if (traffic == 0.0) {
          EXPECT_TRUE(frame.objects.empty()) << kind.name;
        }
      }
    }
  }
}

TEST(Simulation, FramesDoNotDependOnEachOtherNorOnThreads) {
  const Simulation first(find_scene("street"), small_street());
  const Simulation second(find_scene("street"), small_street());
  (void)second.frame(0, Workers(2));
  for (const int threads : {1, 2, 7}) {
    const SimulatedFrame a = first.frame(3, Workers(1));
    const SimulatedFrame b = second.frame(3, Workers(threads));
    EXPECT_EQ(a.scan.measured.points, b.scan.measured.points);
    EXPECT_EQ(a.scan.measured.doppler, b.scan.measured.doppler);
    EXPECT_EQ(a.scan.bodies, b.scan.bodies);
    EXPECT_EQ(a.T_world_sensor.matrix(), b.T_world_sensor.matrix());
  }
}

TEST(Simulation, SeedChangesLayoutAndNoise) {
  SimulationConfig config = small_street();
  config.lidar = without_noise(config.lidar);
  const SimulatedFrame a = Simulation(find_scene("street"), config).frame(0, Workers(1));
  config.seed = 2;
  const SimulatedFrame b = Simulation(find_scene("street"), config).frame(0, Workers(1));
  EXPECT_NE(a.scan.true_range, b.scan.true_range);
}

TEST(Simulation, StampsAreExactAtAwkwardRates) {
  SimulationConfig config = small_street();
  config.lidar.rate_hz = 12.0;
  const Simulation simulation(find_scene("street"), config);
  EXPECT_EQ(simulation.stamp(0), Stamp{0});
  EXPECT_EQ(simulation.stamp(1), Stamp{83'333'333});
  EXPECT_EQ(simulation.stamp(12), Stamp{1'000'000'000});
}

}  // namespace
}  // namespace dynamic_icp::simulation
