// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What a user gets from the commands, on simulated and, where it lies beside the sources, on recorded data.
#include <cmath>
#include <sstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/runs/run_recording.hpp"

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class EndToEnd : public ProgramTest {};

/// A line of frames.jsonl, or summary.json, without what the clock says.
json without_times(const std::string& text) {
  json object = json::parse(text);
  for (const char* key : {"ms", "ms_mean", "ms_median", "ms_p95", "fps"}) {
    object.erase(key);
  }
  return object;
}

TEST_F(EndToEnd, TheFunctionOfTheLibraryWritesTheFilesOfTheProgram) {
  const fs::path by_program = folder_ / "by_program";
  const std::string options = " --save-labels --max-frames 3 --start 1 --threads 2 --period 0.2 --preset paper";
  const Outcome outcome =
      run_program("run --quiet " + street().string() + " --output " + by_program.string() + options);
  ASSERT_EQ(outcome.status, 0) << outcome.text;

  const json record = json::parse(read_file(by_program / "run.json"));
  runs::Recording recording{street(), {}};
  datasets::set(recording.settings, "period", "0.2");
  runs::RunSettings settings;
  settings.output = folder_ / "by_library";
  settings.preset = "paper";
  settings.config = odometry::PaperConfig{};
  settings.threads = 2;
  settings.start = 1;
  settings.max_frames = 3;
  settings.save_labels = true;
  settings.command = record["command"];
  ASSERT_TRUE(runs::run_recording(recording, settings));

  std::size_t labels = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(by_program)) {
    const fs::path name = entry.path().lexically_relative(by_program);
    ASSERT_TRUE(fs::exists(settings.output / name)) << name;
    if (entry.is_directory()) {
      continue;
    }
    const std::string ours = read_file(settings.output / name);
    const std::string theirs = read_file(entry.path());
    labels += name.extension() == ".bin" ? 1 : 0;
    if (name == "summary.json") {
      EXPECT_EQ(without_times(ours), without_times(theirs));
    } else if (name == "frames.jsonl") {
      std::istringstream our_lines(ours);
      std::istringstream their_lines(theirs);
      for (std::string a, b; std::getline(their_lines, b);) {
        ASSERT_TRUE(std::getline(our_lines, a));
        EXPECT_EQ(without_times(a), without_times(b));
      }
    } else {
      EXPECT_EQ(ours, theirs) << name;
    }
  }
  EXPECT_EQ(labels, 3U);
}

/// Mean absolute error of the reported object velocities along the true motion (m/s), for objects nearer than 50 m
/// that a reported one lies at.
double along_motion_error(const fs::path& truth, const fs::path& estimate, std::size_t& count) {
  std::istringstream truth_lines(read_file(truth));
  std::istringstream estimate_lines(read_file(estimate));
  double sum = 0.0;
  count = 0;
  for (std::string t, e; std::getline(truth_lines, t) && std::getline(estimate_lines, e);) {
    const json truth_row = json::parse(t);
    const json estimate_row = json::parse(e);
    for (const json& object : truth_row["objects"]) {
      const auto v = object["velocity_sensor"].get<std::vector<double>>();
      const auto c = object["center_sensor"].get<std::vector<double>>();
      const double speed = std::hypot(v[0], v[1], v[2]);
      for (const json& found : estimate_row["objects"]) {
        const auto w = found["velocity"].get<std::vector<double>>();
        const auto d = found["centroid"].get<std::vector<double>>();
        if (speed > 2.0 && std::hypot(c[0] - d[0], c[1] - d[1], c[2] - d[2]) < 3.0) {
          sum += std::abs((w[0] - v[0]) * v[0] + (w[1] - v[1]) * v[1] + (w[2] - v[2]) * v[2]) / speed;
          ++count;
        }
      }
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

TEST_F(EndToEnd, TheStreetOfTheDemo) {
  const fs::path drive = folder_ / "street";
  ASSERT_EQ(run_program("simulate street --frames 40 --instant --quiet --output " + drive.string()).status, 0);
  const json summary = run_and_summarise(drive.string());
  EXPECT_EQ(summary["frames"], 40);
  EXPECT_LT(summary["rte_rmse_m"].get<double>(), 0.02);
  EXPECT_LT(summary["rre_rmse_deg"].get<double>(), 0.1);
  EXPECT_GT(summary["dynamic_ratio_mean"].get<double>(), 0.005);
  std::size_t count = 0;
  EXPECT_LT(along_motion_error(drive / "objects.jsonl", folder_ / "out" / "objects.jsonl", count), 1.0);
  EXPECT_GE(count, 20u);
}

TEST_F(EndToEnd, TheSameBytesForAnyNumberOfThreadsAndEveryRun) {
  std::string expected;
  for (const char* threads : {"1", "1", "2", "7"}) {
    run_and_summarise(street().string() + " --save-labels --threads " + threads);
    const std::string bytes = read_file(folder_ / "out" / "trajectory.tum") +
                              read_file(folder_ / "out" / "objects.jsonl") +
                              read_file(folder_ / "out" / "labels" / "00012.bin");
    ASSERT_GT(bytes.size(), 1000u);
    if (expected.empty()) {
      expected = bytes;
    }
    EXPECT_EQ(bytes, expected) << threads << " threads";
  }
}

TEST_F(EndToEnd, AblationsRunAndSayWhatTheyAre) {
  for (const char* ablation : {"no-vf", "no-dpp", "no-dr"}) {
    run_and_summarise(street().string() + " --preset paper --max-frames 3 --ablation " + ablation);
    EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["ablation"], ablation);
  }
}

TEST_F(EndToEnd, EveryMethodRunsAndSaysWhatItTookForGranted) {
  for (const std::string method :
       {"dynamic-icp", "doppler-icp", "point-to-point", "point-to-plane", "gicp", "kiss-icp"}) {
    const json summary = run_and_summarise(street().string() + " --max-frames 4 --method " + method);
    EXPECT_EQ(summary["method"], method);
    const json record = json::parse(read_file(folder_ / "out" / "run.json"));
    EXPECT_EQ(record["method"], method);
    EXPECT_EQ(record["assumptions"].size(), method == "doppler-icp" ? 1u : 0u) << "the street has no calibration";
    const std::string scans = (street() / "point_clouds").string();
    const Outcome pair =
        run_program("register " + scans + "/00001.bin " + scans + "/00002.bin --method " + method + " 2>/dev/null");
    ASSERT_EQ(pair.status, 0) << pair.text;
    EXPECT_EQ(json::parse(pair.text)["assumptions"].size(), method == "doppler-icp" ? 1u : 0u);
  }
  EXPECT_EQ(
      run_program("run " + street().string() + " --method gicp --ablation no-vf --output " + (folder_ / "x").string())
          .status,
      2);
}

TEST_F(EndToEnd, WhatIsKnownOfTheMethodsShowsInASmoothTunnelAtSpeed) {
  const fs::path tunnel = folder_ / "tunnel";
  ASSERT_EQ(
      run_program("simulate tunnel --instant --calibration --frames 12 --quiet --output " + tunnel.string()).status, 0);
  const auto rte = [&](const std::string& method) {
    return run_and_summarise(tunnel.string() + " --preset paper --method " + method)["rte_rmse_m"].get<double>();
  };
  EXPECT_LT(rte("doppler-icp"), 0.05) << "the Doppler holds the way along the tunnel";
  EXPECT_GT(rte("point-to-plane"), 1.0) << "nothing in the geometry does";
  EXPECT_GT(rte("kiss-icp"), 1.0) << "it does not start at 20 m/s";
}

TEST_F(EndToEnd, RunRecordsWhatItDid) {
  write_file(folder_ / "my.yaml", "preprocess:\n  voxel:\n    voxel_size_m: 0.4\n");
  run_and_summarise(street().string() + " --start 2 --max-frames 4 --preset paper --config " +
                    (folder_ / "my.yaml").string() + " --set registration.max_iterations=50");
  const json record = json::parse(read_file(folder_ / "out" / "run.json"));
  EXPECT_EQ(record["configuration"]["preprocess.voxel.voxel_size_m"], 0.4);
  EXPECT_EQ(record["configuration"]["registration.max_iterations"], 50);
  EXPECT_EQ(record["preset"], "paper");
  EXPECT_EQ(record["input"]["format"], "dicp");
  EXPECT_EQ(record["start"], 2);
  EXPECT_NE(record["command"].get<std::string>().find("--max-frames 4"), std::string::npos);
  std::istringstream frames(read_file(folder_ / "out" / "frames.jsonl"));
  std::string first;
  std::getline(frames, first);
  EXPECT_EQ(json::parse(first)["index"], 2);
  EXPECT_EQ(json::parse(first)["reason"], "first");
}

TEST_F(EndToEnd, RunSaysWhatItFoundAndDidAboutTheSweep) {
  const fs::path swept = folder_ / "swept";
  ASSERT_EQ(run_program("simulate street --frames 3 --quiet --output " + swept.string()).status, 0);
  const auto expect_sweep = [&](const std::string& arguments, const std::string& times, double duration_s,
                                bool deskewed) {
    run_and_summarise(arguments);
    const json sweep = json::parse(read_file(folder_ / "out" / "run.json"))["sweep"];
    EXPECT_EQ(sweep["times"], times) << arguments;
    EXPECT_EQ(sweep["deskewed"], deskewed) << arguments;
    const json seconds = sweep.at("duration_s");
    EXPECT_EQ(seconds.is_null(), duration_s == 0.0) << arguments;
    EXPECT_NEAR(seconds.is_null() ? 0.0 : seconds.get<double>(), duration_s, 0.002) << arguments;
  };
  expect_sweep(swept.string(), "in the data", 0.1, true);
  expect_sweep(swept.string() + " --set sweep.deskew=false", "in the data", 0.1, false);
  expect_sweep(swept.string() + " --preset paper", "in the data", 0.1, false);
  expect_sweep(swept.string() + " --method gicp", "in the data", 0.1, false);
  expect_sweep(swept.string() + " --method kiss-icp --set kiss_icp.deskew=true", "in the data", 0.1, true);
  expect_sweep(swept.string() + " --method kiss-icp --set kiss_icp.deskew=false", "in the data", 0.1, false);
  const std::string instant = street().string() + " --max-frames 3";
  expect_sweep(instant, "none", 0.0, false);
  expect_sweep(instant + " --set sweep.declared_duration_s=0.05", "declared", 0.05, true);
  expect_sweep(instant + " --set sweep.declared_duration_s=0.05 --set sweep.deskew=false", "declared", 0.05, false);
  expect_sweep(instant + " --method kiss-icp", "none", 0.0, false);
  const Outcome printed = run_program("run " + swept.string() + " --output " + (folder_ / "told").string());
  EXPECT_NE(printed.text.find("sweep        deskewed, 0.100 s, times in the data"), std::string::npos) << printed.text;
}

TEST_F(EndToEnd, RunFindsTheSweepOfPointsWithoutTimes) {
  const fs::path swept = folder_ / "swept";
  ASSERT_EQ(run_program("simulate street --frames 20 --quiet --output " + swept.string()).status, 0);
  const json timed = run_and_summarise(swept.string());
  fs::remove_all(swept / "times");
  const json as_instant = run_and_summarise(swept.string() + " --set sweep.search=false");
  EXPECT_FALSE(json::parse(read_file(folder_ / "out" / "run.json"))["sweep"].contains("search"));
  const json found = run_and_summarise(swept.string());
  const json run = json::parse(read_file(folder_ / "out" / "run.json"));
  EXPECT_EQ(run["sweep"]["times"], "found");
  EXPECT_EQ(run["sweep"]["search"]["hypothesis"], "azimuth_cw");
  EXPECT_GT(run["sweep"]["search"]["margin_sigma"].get<double>(), 4.0);
  EXPECT_NEAR(run["sweep"]["duration_s"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(run["configuration"]["sweep.declared_left_to_right"], true) << "what reads the run again deskews alike";
  EXPECT_NE(run["assumptions"].dump().find("clockwise (left to right)"), std::string::npos);
  EXPECT_LT(found["rte_rmse_m"].get<double>(), 1.2 * timed["rte_rmse_m"].get<double>());
  EXPECT_LT(found["rre_rmse_deg"].get<double>(), 1.2 * timed["rre_rmse_deg"].get<double>());
  EXPECT_GT(as_instant["rte_rmse_m"].get<double>(), 2.0 * timed["rte_rmse_m"].get<double>());
}

TEST_F(EndToEnd, RegisterPrintsThePairAsJson) {
  const std::string scans = (street() / "point_clouds").string();
  const Outcome outcome = run_program("register " + scans + "/00001.bin " + scans + "/00002.bin --preset paper");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const json pair = json::parse(outcome.text);
  EXPECT_TRUE(pair["converged"].get<bool>());
  EXPECT_EQ(pair["covariance"].size(), 6u);
  EXPECT_NEAR(pair["T_target_source"][0][3].get<double>(), -1.3, 0.1) << "13 m/s for 0.1 s";
}

TEST_F(EndToEnd, EvaluateComparesARunWithTheTruth) {
  const json summary = run_and_summarise(street().string());
  const Outcome outcome = run_program("evaluate --json " + (folder_ / "out" / "trajectory.tum").string() + " " +
                                      (street() / "ref_poses.txt").string());
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  const json evaluation = json::parse(outcome.text);
  EXPECT_EQ(evaluation["matched"], 12);
  EXPECT_NEAR(evaluation["path_length_m"].get<double>(), summary["path_length_m"].get<double>(), 1e-9);
  EXPECT_EQ(evaluation["consistency"]["motions"], 11) << "of frames.jsonl beside the trajectory";
  EXPECT_NEAR(evaluation["consistency"]["nees_translation"].get<double>(), summary["nees_translation"].get<double>(),
              1e-6);
  const Outcome itself =
      run_program("evaluate " + (street() / "ref_poses.txt").string() + " " + (street() / "ref_poses.txt").string());
  EXPECT_EQ(itself.status, 0) << itself.text;
}

TEST_F(EndToEnd, InfoTellsTheSignOfTheDoppler) {
  const Outcome outcome = run_program("info " + street().string());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.text.find("positive away from the sensor"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("10.00 Hz"), std::string::npos) << outcome.text;
  const std::string counted = "diagnosis    of ";
  EXPECT_LE(std::stoi(outcome.text.substr(outcome.text.find(counted) + counted.size())), 12) << "each scan once";
}

TEST_F(EndToEnd, ObjectsAreComparedAsTracks) {
  const fs::path out = folder_ / "out";
  run_and_summarise(street().string());
  const std::string command = "evaluate --objects " + out.string() + " " + street().string();
  const json tracking = json::parse(run_program(command + " --json").text);
  EXPECT_EQ(tracking["scans"], 7) << "of 12 without the first five";
  EXPECT_GT(tracking["true_objects"], 0);
  EXPECT_GT(tracking["hota"], 0.3);
  EXPECT_LE(tracking["hota"], 1.0);
  EXPECT_LT(tracking["heading_mae_deg"], 10.0);
  EXPECT_GT(tracking["points_in_box_median"], 0.8);
  EXPECT_TRUE(tracking["map_ghosts"].is_null()) << "the run wrote no labels";
  EXPECT_NE(run_program(command).text.find("HOTA"), std::string::npos);

  const Outcome contradiction = run_program(command + " --gap-frames 2");
  EXPECT_EQ(contradiction.status, 2);
  const Outcome no_truth = run_program("evaluate --objects " + out.string() + " " + folder_.string());
  EXPECT_EQ(no_truth.status, 1);
  EXPECT_NE(no_truth.text.find((folder_ / "objects.jsonl").string()), std::string::npos) << no_truth.text;
  run_and_summarise(street().string() + " --preset paper");
  const Outcome no_boxes = run_program(command);
  EXPECT_EQ(no_boxes.status, 1);
  EXPECT_NE(no_boxes.text.find("objects without boxes; expected those of a run with preset 'default'"),
            std::string::npos)
      << no_boxes.text;
}

TEST_F(EndToEnd, RecordedRadarScans) {
  const fs::path recording = source_folder() / ".." / "shared" / "data" / "radar-campus";
  if (!fs::exists(recording)) {
    GTEST_SKIP() << "no recording beside the sources";
  }
  const json summary = run_and_summarise(recording.string() + " --preset paper");
  EXPECT_EQ(summary["frames"], 120);
  EXPECT_GE(summary["convergence_rate"].get<double>(), 0.99);
  EXPECT_LE(summary["ate_rmse_m"].get<double>(), 0.35);
  EXPECT_EQ(read_file(folder_ / "out" / "trajectory.tum").find("nan"), std::string::npos);
  EXPECT_NE(run_program("info " + recording.string()).text.find("12.00 Hz"), std::string::npos);

  // Sparse scans: the local map must carry them, not merely the Doppler.
  const json by_default = run_and_summarise(recording.string() + " --force");
  EXPECT_LE(by_default["ate_rmse_m"].get<double>(), 0.31);
  const json& statuses = by_default.at("statuses");
  EXPECT_LE(statuses.value("degenerate", 0), 6);
  EXPECT_LE(statuses.value("lost", 0), 1);
}

}  // namespace
}  // namespace dynamic_icp::tests
