// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/timing.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/tools/simulation/simulation.hpp"

#include "testing/scanned_worlds.hpp"

namespace dynamic_icp::simulation {
namespace {

SimulationConfig drive() {
  SimulationConfig config = default_config(scenes::find_scene("street"));
  config.frames = 500;
  FmcwLidarConfig& lidar = config.rig.sensors.front().lidar;
  lidar = without_noise(lidar);
  lidar.columns = 60;
  lidar.rows = 8;
  return config;
}

TEST(Timing, IsExactUnlessAskedFor) {
  const Simulation simulation(scenes::find_scene("street"), drive());
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const ScanTime time = simulation.scan_time(i);
    EXPECT_EQ(time.begin, simulation.stamp(i));
    EXPECT_EQ(time.stamp, simulation.stamp(i));
    EXPECT_FALSE(time.missing);
  }
}

TEST(Timing, JitterAndLossesHaveTheirSize) {
  SimulationConfig config = drive();
  config.rig.sensors.front().lidar.timing.period_jitter_s = 0.003;
  config.rig.sensors.front().lidar.timing.stamp_jitter_s = 0.0005;
  config.rig.sensors.front().lidar.timing.missing_scan_rate = 0.2;
  const Simulation simulation(scenes::find_scene("street"), config);
  Statistics begin, stamp;
  double missing = 0.0;
  for (std::size_t i = 1; i < simulation.size(); ++i) {
    const ScanTime time = simulation.scan_time(i);
    EXPECT_LT(simulation.scan_time(i - 1).stamp, time.stamp);
    begin.add(seconds_between(simulation.stamp(i), time.begin));
    stamp.add(seconds_between(time.begin, time.stamp));
    missing += time.missing ? 1.0 : 0.0;
  }
  EXPECT_NEAR(begin.mean(), 0.0, 4.0 * 0.003 / std::sqrt(begin.n));
  EXPECT_NEAR(begin.deviation(), 0.003, 4.0 * 0.003 / std::sqrt(2.0 * begin.n));
  EXPECT_NEAR(stamp.mean(), 0.0, 4.0 * 0.0005 / std::sqrt(stamp.n));
  EXPECT_NEAR(stamp.deviation(), 0.0005, 4.0 * 0.0005 / std::sqrt(2.0 * stamp.n));
  EXPECT_NEAR(missing / 499.0, 0.2, share_error(0.2, 499.0));
}

TEST(Timing, OrderSurvivesAnyJitter) {
  SimulationConfig config = drive();
  config.rig.sensors.front().lidar.timing.period_jitter_s = 1.0;
  config.rig.sensors.front().lidar.timing.stamp_jitter_s = 1.0;
  const Simulation simulation(scenes::find_scene("street"), config);
  for (std::size_t i = 1; i < simulation.size(); ++i) {
    EXPECT_LT(simulation.scan_time(i - 1).stamp, simulation.scan_time(i).stamp);
  }
}

TEST(Timing, TruthIsThatOfTheBeginAndTheStampWhatTheSensorSays) {
  SimulationConfig config = drive();
  config.rig.sensors.front().lidar.timing = {0.03, 0.004, 0.002, 0.01, 0.0};
  const Simulation simulation(scenes::find_scene("street"), config);
  const SimulatedFrame frame = simulation.frame(7, Workers(1));
  const ScanTime time = simulation.scan_time(7);
  EXPECT_NEAR(seconds_between(simulation.stamp(7), time.begin), 0.03, 0.024);
  EXPECT_EQ(frame.begin, time.begin);
  EXPECT_EQ(frame.scan.measured.stamp, time.stamp);
  EXPECT_NE(time.begin, time.stamp);
  const double begin_s = seconds_between(Stamp{}, time.begin);
  EXPECT_EQ(frame.sensor.T_world_sensor.matrix(), simulation.sensor()(begin_s).T_world_body.matrix());
  EXPECT_NEAR(frame.scan.measured.times.front(), 0.01, 1e-12);
  // Each point was measured at its stated time less the offset, after the true begin.
  for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
    const SensorState state = simulation.sensor_state(begin_s + frame.scan.measured.times[i] - 0.01);
    if (frame.scan.bodies[i] == 0) {
      EXPECT_NEAR(frame.scan.measured.doppler[i],
                  -frame.scan.measured.points[i].normalized().dot(state.velocity_sensor), 1e-9);
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
