// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What a user gets from the commands, on simulated and, where it lies beside the sources, on recorded data.
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class EndToEnd : public ProgramTest {
 protected:
  json run_and_summarise(const std::string& arguments) {
    const fs::path out = folder_ / "out";
    const Outcome outcome = run_program("run --quiet --force --output " + out.string() + " " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return json::parse(read_file(out / "summary.json"));
  }
};

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

TEST_F(EndToEnd, AnOptionTakesOneValueAndLeavesTheRest) {
  run_and_summarise("--max-frames 2 --set registration.max_iterations=7 " + street().string());
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["configuration"]["registration.max_iterations"], 7);
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
  const Outcome itself =
      run_program("evaluate " + (street() / "ref_poses.txt").string() + " " + (street() / "ref_poses.txt").string());
  EXPECT_EQ(itself.status, 0) << itself.text;
}

TEST_F(EndToEnd, InfoTellsTheSignOfTheDoppler) {
  const Outcome outcome = run_program("info " + street().string());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.text.find("relative, positive away from the sensor"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("10.00 Hz"), std::string::npos) << outcome.text;
}

TEST_F(EndToEnd, ReportAndPlotsAreMadeFromARun) {
  run_and_summarise(street().string() + " --report --save-labels");
  EXPECT_GT(read_file(folder_ / "out" / "report.html").size(), 10'000u);
  const Outcome plots = run_program("plot " + (folder_ / "out").string());
  ASSERT_EQ(plots.status, 0) << plots.text;
  for (const char* name : {"trajectory.svg", "errors.svg", "speed.svg", "scan.svg"}) {
    EXPECT_TRUE(read_file(folder_ / "out" / "plots" / name).find("<svg") != std::string::npos) << name;
  }
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
}

}  // namespace
}  // namespace dynamic_icp::tests
