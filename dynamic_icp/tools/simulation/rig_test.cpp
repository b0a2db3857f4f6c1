// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/rig.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

std::string refusal(const std::string& yaml) {
  try {
    (void)parse_rig(yaml, "car.yaml");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Rig, PresetsAreValidAndDescribed) {
  EXPECT_GE(rig_presets().size(), 4U);
  for (const RigPreset& preset : rig_presets()) {
    const Rig rig = find_rig(std::string(preset.name));
    EXPECT_EQ(rig.name, preset.name);
    EXPECT_FALSE(rig.description.empty());
    EXPECT_NO_THROW(check(rig));
  }
  EXPECT_EQ(find_rig("front-pair").sensors.size(), 2U);
  EXPECT_EQ(find_rig("aevascenes-six").sensors.size(), 6U);
}

TEST(Rig, AeriesTwoLooksAsDocumented) {
  const FmcwLidarConfig lidar = find_rig("aeries-ii").sensors.front().lidar;
  EXPECT_EQ(lidar.horizontal_fov_deg, 120.0);
  EXPECT_EQ(lidar.vertical_fov_deg, 19.2);
  EXPECT_EQ(lidar.rate_hz, 10.0);
  EXPECT_FALSE(lidar.row_by_row);
  EXPECT_EQ(lidar.doppler_step_mps, 1.0 / 256.0);
}

TEST(Rig, ReadsSensorsWithTheirMounts) {
  const Rig rig = parse_rig(
      "sensors:\n"
      "  - name: a\n"
      "    mount: {x_m: 3.0, yaw_deg: 90}\n"
      "    lidar: {rows: 5, row_by_row: true}\n"
      "  - name: b\n",
      "some/car.yaml");
  EXPECT_EQ(rig.name, "car");
  ASSERT_EQ(rig.sensors.size(), 2U);
  EXPECT_EQ(rig.sensors[0].mount.x_m, 3.0);
  EXPECT_EQ(rig.sensors[0].mount.yaw_deg, 90.0);
  EXPECT_EQ(rig.sensors[0].lidar.rows, 5);
  EXPECT_TRUE(rig.sensors[0].lidar.row_by_row);
  EXPECT_EQ(rig.sensors[1].lidar.rows, FmcwLidarConfig{}.rows);
}

TEST(Rig, WithoutNoiseNothingErrs) {
  for (const char* name : {"aeries-ii-real", "radar-4d-real"}) {
    Rig rig = without_noise(find_rig(name));
    SensorConfig& sensor = rig.sensors.front();
    SensorConfig perfect;
    for (const ConfigField& field : fields(sensor)) {
      for (const ConfigField& expected : fields(perfect)) {
        const bool is_error =
            field.key.find("_error.") != std::string::npos || field.key.find("timing.") != std::string::npos;
        if (field.key == expected.key && is_error) {
          EXPECT_EQ(value_text(field), value_text(expected)) << field.key;
        }
      }
    }
    EXPECT_EQ(rig.vibration.wheel.amplitude_mm, 0.0);
    EXPECT_GT(find_rig(name).vibration.wheel.amplitude_mm, 0.0);
  }
}

TEST(Rig, RefusalsNameFileLineAndRange) {
  const std::string band = refusal("vibration:\n  wheel: {low_hz: 20}\nsensors:\n  - name: a\n");
  EXPECT_NE(band.find("high_hz"), std::string::npos) << band;
  const std::string range = refusal("sensors:\n  - name: a\n    lidar:\n      rows: 0\n");
  EXPECT_NE(range.find("car.yaml: line 4"), std::string::npos) << range;
  EXPECT_NE(range.find("1 to 1024"), std::string::npos) << range;
  const std::string key = refusal("sensors:\n  - name: a\n    lidars: {}\n");
  EXPECT_NE(key.find("line 3"), std::string::npos) << key;
  EXPECT_NE(key.find("lidars"), std::string::npos) << key;
  const std::string name = refusal("sensors:\n  - name: ../up\n");
  EXPECT_NE(name.find("line 2"), std::string::npos) << name;
  const std::string sweep = refusal("sensors:\n  - name: a\n    lidar: {sweep_s: 0.2}\n");
  EXPECT_NE(sweep.find("line 3"), std::string::npos) << sweep;
  EXPECT_NE(refusal("sensors: []\n").find("no sensor"), std::string::npos);
  EXPECT_NE(refusal("sensors:\n  - name: a\n  - name: a\n").find("twice"), std::string::npos);
  EXPECT_NE(refusal("sensors:\n  - name: a\n  - name: b\n    lidar: {rate_hz: 5}\n").find("'b'"), std::string::npos);
}

TEST(Rig, UnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    (void)find_rig("eyes");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("aeries-ii, front-pair"), std::string::npos) << error.what();
  }
  EXPECT_THROW((void)find_rig("/nowhere/eyes.yaml"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::simulation
