// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The command simulate as a user meets it.
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Simulate : public ProgramTest {
 protected:
  /// Simulates into the folder "out".
  [[nodiscard]] Outcome simulate(const std::string& arguments) const {
    return run_program("simulate " + arguments + " --force --output " + out().string());
  }

  void expect_usage_error(const std::string& arguments, const std::string& words) const {
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << arguments << "\n" << outcome.text;
    EXPECT_FALSE(fs::exists(out()));
  }

  [[nodiscard]] fs::path out() const { return folder_ / "out"; }

  const std::string kFew = " --frames 2 --quiet --set lidar.columns=60 --set lidar.rows=8";
};

TEST_F(Simulate, EverySensorWorksInEveryLayout) {
  for (const std::string sensor :
       {"aeries-ii", "front-pair", "aevascenes-six", "spinning-360", "radar-4d", "aeries-ii-real", "radar-4d-real"}) {
    for (const std::string layout : {"dicp", "hercules", "aevascenes"}) {
      const Outcome outcome = simulate("city --sensor " + sensor + " --layout " + layout + kFew);
      ASSERT_EQ(outcome.status, 0) << outcome.text;
      const json scene = json::parse(read_file(out() / "scene.json"));
      EXPECT_EQ(scene["layout"], layout);
      EXPECT_EQ(scene["rig"]["name"], sensor);
      EXPECT_GT(scene["points"], 100);
      EXPECT_TRUE(fs::exists(out() / "overview.svg"));
    }
  }
}

TEST_F(Simulate, SummaryTellsWhatWasMade) {
  const Outcome outcome = simulate("street --frames 2 --set speed=20 --set lidar.columns=60");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  for (const char* words : {"street, seed 1", "60 x 64 rays over 120 x 19.2 deg", "swept in 0.1 s",
                            "2 scans, 0.2 s, 2 m", "scans/s", "layout dicp"}) {
    EXPECT_NE(outcome.text.find(words), std::string::npos) << words << "\n" << outcome.text;
  }
}

TEST_F(Simulate, OneSensorOfSeveralCanBeChanged) {
  ASSERT_EQ(simulate("street --sensor front-pair --set front_narrow_lidar.lidar.rows=3" + kFew).status, 0);
  json sensors = json::parse(read_file(out() / "scene.json"))["rig"]["sensors"];
  EXPECT_EQ(sensors[0]["lidar.rows"], 8) << "settings apply in order";
  EXPECT_EQ(sensors[1]["lidar.rows"], 8);
  ASSERT_EQ(simulate("street --sensor front-pair" + kFew + " --set front_narrow_lidar.lidar.rows=3").status, 0);
  sensors = json::parse(read_file(out() / "scene.json"))["rig"]["sensors"];
  EXPECT_EQ(sensors[0]["lidar.rows"], 8);
  EXPECT_EQ(sensors[1]["lidar.rows"], 3);
}

TEST_F(Simulate, APrintedSensorFileIsTheSensor) {
  ASSERT_EQ(run_program("simulate --show-sensor radar-4d > " + (folder_ / "radar-4d.yaml").string()).status, 0);
  ASSERT_EQ(simulate("street --frames 2 --quiet --sensor " + (folder_ / "radar-4d.yaml").string()).status, 0);
  const std::string by_file = read_file(out() / "point_clouds" / "00002.bin");
  ASSERT_EQ(simulate("street --frames 2 --quiet --sensor radar-4d").status, 0);
  EXPECT_EQ(read_file(out() / "point_clouds" / "00002.bin"), by_file);
  EXPECT_FALSE(fs::exists(out() / "times")) << "the radar is instant";
}

TEST_F(Simulate, SweptAndInstantScansRunThroughTheOdometry) {
  for (const std::string mode : {"", " --instant", " --calibration"}) {
    ASSERT_EQ(simulate("street --frames 5 --quiet" + mode).status, 0);
    EXPECT_EQ(fs::exists(out() / "times"), mode != " --instant");
    EXPECT_EQ(fs::exists(out() / "calibration.json"), mode == " --calibration");
    const std::string run = (folder_ / "run").string();
    ASSERT_EQ(run_program("run --quiet --force " + out().string() + " --output " + run).status, 0);
    EXPECT_LT(json::parse(read_file(folder_ / "run" / "summary.json"))["rte_rmse_m"].get<double>(), 0.03) << mode;
  }
}

TEST_F(Simulate, TheExampleSceneFileWorks) {
  const std::string file = (source_folder() / "examples" / "scenes" / "crossing.yaml").string();
  ASSERT_EQ(simulate(file + kFew).status, 0);
  EXPECT_EQ(json::parse(read_file(out() / "scene.json"))["scene"], "crossing");
  EXPECT_EQ(json::parse(read_file(out() / "scene.json"))["settings"]["speed"], 10.0);
}

TEST_F(Simulate, WrongFilesAreRefusedWithTheLine) {
  write_file(folder_ / "scene.yaml",
             "description: d\nspeed_mps: 10\nroutes: {main: {}}\nvehicle: {route: main}\nstatics:\n  - box: {size_m: "
             "[1, 1, -1], position_m: [0, 0, 0]}\n");
  expect_usage_error((folder_ / "scene.yaml").string(), "scene.yaml: line 6");
  write_file(folder_ / "sensor.yaml", "sensors:\n  - name: a\n    lidar:\n      rows: 0\n");
  expect_usage_error("street --sensor " + (folder_ / "sensor.yaml").string(), "sensor.yaml: line 4");
  write_file(folder_ / "torn.yaml", "a: [1,\n");
  EXPECT_EQ(simulate((folder_ / "torn.yaml").string()).status, 1);
  EXPECT_EQ(simulate("/nowhere/scene.yaml").status, 1);
}

TEST_F(Simulate, WrongUseIsRefused) {
  expect_usage_error("moon", "street, city");
  expect_usage_error("street --sensor eyes", "aeries-ii");
  expect_usage_error("street --layout vhs", "hercules");
  expect_usage_error("street --calibration --layout hercules", "dicp");
  expect_usage_error("street --set speed=-5", "0 to 70 m/s");
  expect_usage_error("street --set lidar.sweep_s=0.2", "sweep_s");
  expect_usage_error("street --set lidar.rowz=3", "lidar.rows");
  expect_usage_error("street --frames 0", "frames");
  EXPECT_EQ(run_program("simulate street").status, 2) << "--output is missing";
}

TEST_F(Simulate, NothingIsLeftWhereNothingCanBeWritten) {
  write_file(folder_ / "file", "in the way");
  const Outcome outcome = run_program("simulate street --frames 2 --output " + (folder_ / "file" / "out").string());
  EXPECT_EQ(outcome.status, 1) << outcome.text;
  EXPECT_NE(outcome.text.find((folder_ / "file").string()), std::string::npos) << outcome.text;
  EXPECT_EQ(read_file(folder_ / "file"), "in the way");
}

TEST_F(Simulate, ListNamesScenesAndSensors) {
  const Outcome outcome = run_program("simulate --list");
  EXPECT_EQ(outcome.status, 0);
  for (const char* name : {"street", "stationary", "aeries-ii", "radar-4d"}) {
    EXPECT_NE(outcome.text.find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace dynamic_icp::tests
