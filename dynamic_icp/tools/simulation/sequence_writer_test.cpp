// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/sequence_writer.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/written_files.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;

class SequenceFiles : public WrittenFiles {
 protected:
  void write(const fs::path& to, const SequenceOptions& options = {}, int threads = 2) const {
    fs::create_directories(to);
    write(to, simulation_, options, threads);
  }

  static void write(const fs::path& to, const Simulation& simulation, const SequenceOptions& options, int threads) {
    const Workers workers(threads);
    SequenceWriter writer(to, simulation, options);
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      for (std::size_t sensor = 0; sensor < simulation.config().rig.sensors.size(); ++sensor) {
        writer.add(simulation.frame(i, workers, sensor), sensor);
      }
    }
    writer.finish("1.2.3");
  }

  /// Two small sensors.
  static SimulationConfig pair() {
    SimulationConfig pair = config();
    pair.rig.sensors.push_back(pair.rig.sensors.front());
    pair.rig.sensors[0].name = "left";
    pair.rig.sensors[1].name = "right";
    return pair;
  }
};

TEST_F(SequenceFiles, SummaryTellsWhatWasMade) {
  write(folder_);
  const auto summary = nlohmann::json::parse(content(folder_ / "scene.json"));
  EXPECT_EQ(summary["scene"], "street");
  EXPECT_EQ(summary["version"], "1.2.3");
  EXPECT_EQ(summary["layout"], "dicp");
  EXPECT_EQ(summary["settings"]["frames"], 4);
  EXPECT_EQ(summary["settings"]["speed"], 13.0);
  EXPECT_EQ(summary["rig"]["sensors"][0]["lidar.columns"], 300);
  EXPECT_EQ(summary["scans"], 4);
  EXPECT_EQ(summary["rays"], 4 * 300 * 32);
  std::size_t points = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    points += simulation_.frame(i, workers_).scan.bodies.size();
  }
  EXPECT_EQ(summary["points"], points);
}

TEST_F(SequenceFiles, SameBytesForAnyNumberOfThreadsInEveryLayout) {
  for (const Layout layout :
       {Layout::kDicp, Layout::kHercules, Layout::kHelipr, Layout::kBoreas, Layout::kAevaScenes}) {
    fs::remove_all(folder_);
    write(folder_ / "a", {layout, true, false}, 1);
    write(folder_ / "b", {layout, true, false}, 7);
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "a")) {
      if (entry.is_regular_file()) {
        EXPECT_EQ(content(entry.path()), content(folder_ / "b" / fs::relative(entry.path(), folder_ / "a")));
        ++files;
      }
    }
    EXPECT_GE(files, 4U + 4U + 4U + 5U);  // points, labels, truth, one file each of the rest
  }
}

TEST_F(SequenceFiles, SensorsHaveFoldersOfTheirOwn) {
  const Simulation simulation(scenes::find_scene("street"), pair());
  write(folder_, simulation, {}, 2);
  for (const char* name : {"left", "right"}) {
    EXPECT_TRUE(fs::exists(folder_ / name / "point_clouds" / "00004.bin"));
    EXPECT_TRUE(fs::exists(folder_ / name / "labels" / "00004.bin"));
    EXPECT_TRUE(fs::exists(folder_ / name / "ref_poses.txt"));
  }
  EXPECT_TRUE(fs::exists(folder_ / "scene.json"));
  EXPECT_FALSE(fs::exists(folder_ / "point_clouds"));
}

TEST_F(SequenceFiles, AevaScenesKeepsAllSensorsInOneRecording) {
  const Simulation simulation(scenes::find_scene("street"), pair());
  write(folder_, simulation, {Layout::kAevaScenes, false, false}, 2);
  EXPECT_TRUE(fs::exists(folder_ / "sequence.json"));
  EXPECT_TRUE(fs::exists(folder_ / "right" / "labels" / "00004.bin"));
  const auto scans = std::distance(fs::directory_iterator(folder_ / "pointcloud_raw"), fs::directory_iterator());
  EXPECT_EQ(scans, 8);
}

TEST_F(SequenceFiles, LayoutsAreFoundByName) {
  EXPECT_EQ(find_layout("hercules"), Layout::kHercules);
  EXPECT_EQ(find_layout("helipr"), Layout::kHelipr);
  EXPECT_EQ(find_layout("boreas"), Layout::kBoreas);
  EXPECT_THROW(find_layout("kitti"), UsageError);
  EXPECT_THROW(SequenceWriter(folder_, simulation_, {Layout::kHercules, false, true}), UsageError);
}

TEST_F(SequenceFiles, FailuresNameFileAndReason) {
  const auto expect_fault = [](const auto& action, const std::string& file) {
    try {
      action();
      FAIL() << file;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("cannot"), std::string::npos) << error.what();
    }
  };
  std::ofstream(folder_ / "labels") << "a file where a folder must be";
  expect_fault([&] { const SequenceWriter writer(folder_, simulation_); }, "labels");
  fs::remove(folder_ / "labels");
  expect_fault(
      [&] {
        SequenceWriter writer(folder_, simulation_);
        fs::remove_all(folder_ / "point_clouds");
        writer.add(simulation_.frame(0, workers_));
      },
      "00001.bin");
  // A full disk.
  if (fs::exists("/dev/full")) {
    fs::remove_all(folder_ / "point_clouds");
    fs::remove(folder_ / "ego.jsonl");
    fs::create_symlink("/dev/full", folder_ / "ego.jsonl");
    expect_fault([&] { write(folder_); }, "ego.jsonl: cannot write: No space left");
  }
}

}  // namespace
}  // namespace dynamic_icp::simulation
