// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What a user gets from the commands, on simulated and, where it lies beside the sources, on recorded data.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "dynamic_icp/recording/runs/run_recording.hpp"

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

using Point = std::array<double, 3>;

/// A pose as TUM files and objects.jsonl state it.
struct Pose {
  Point t{};
  std::array<double, 4> q{};  ///< x y z w

  /// R p by p + 2 v x (v x p + w p).
  [[nodiscard]] Point turn(const Point& p, double w) const {
    const auto cross = [&](const Point& b) -> Point {
      return {q[1] * b[2] - q[2] * b[1], q[2] * b[0] - q[0] * b[2], q[0] * b[1] - q[1] * b[0]};
    };
    const Point c = cross(p);
    const Point outer = cross({c[0] + w * p[0], c[1] + w * p[1], c[2] + w * p[2]});
    return {p[0] + 2.0 * outer[0], p[1] + 2.0 * outer[1], p[2] + 2.0 * outer[2]};
  }
  [[nodiscard]] Point out(const Point& p) const {
    const Point r = turn(p, q[3]);
    return {r[0] + t[0], r[1] + t[1], r[2] + t[2]};
  }
  [[nodiscard]] Point in(const Point& p) const { return turn({p[0] - t[0], p[1] - t[1], p[2] - t[2]}, -q[3]); }
};

std::vector<Pose> read_poses(const fs::path& path) {
  std::vector<Pose> poses;
  std::istringstream lines(read_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream numbers(line);
    double stamp = 0.0;
    Pose pose;
    if (numbers >> stamp >> pose.t[0] >> pose.t[1] >> pose.t[2] >> pose.q[0] >> pose.q[1] >> pose.q[2] >> pose.q[3]) {
      poses.push_back(pose);
    }
  }
  return poses;
}

std::vector<float> floats_of(const std::string& bytes) {
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

std::array<int, 3> cell_of(const Point& p, double edge_m) {
  std::array<int, 3> cell{};
  for (std::size_t i = 0; i < 3; ++i) {
    cell[i] = static_cast<int>(std::floor(p[i] / edge_m));
  }
  return cell;
}

/// The truth of a simulated drive of instant scans in world axes.
struct TrueScene {
  static constexpr double kEdge_m = 0.2;
  static constexpr double kGround_m = 0.3;  // what a body drives on lies in the lowest part of its box

  explicit TrueScene(const fs::path& drive) {
    const std::vector<Pose> poses = read_poses(drive / "ref_poses.txt");
    std::istringstream bodies(read_file(drive / "objects.jsonl"));
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const std::string name = "000" + std::string(k < 9 ? "0" : "") + std::to_string(k + 1) + ".bin";
      const std::vector<float> points = floats_of(read_file(drive / "point_clouds" / name));
      const std::string labels = read_file(drive / "labels" / name);
      for (std::size_t i = 0; 4 * i + 3 < points.size(); ++i) {
        const Point p = poses[k].out({points[4 * i], points[4 * i + 1], points[4 * i + 2]});
        std::int32_t label = 0;
        std::memcpy(&label, labels.data() + 4 * i, 4);
        all.push_back(p);
        if (label == 0) {
          still.insert(cell_of(p, kEdge_m));
        }
      }
      std::string line;
      std::getline(bodies, line);
      const json row = json::parse(line);
      for (const json& body : row["objects"]) {
        const auto c = body["center_sensor"].get<Point>();
        boxes.push_back(
            {poses[k], {c, body["orientation_sensor_xyzw"].get<std::array<double, 4>>()}, body["size"].get<Point>()});
      }
    }
  }

  /// Whether a surface that stands still was seen within a voxel's reach.
  [[nodiscard]] bool is_near_still(const Point& p) const {
    const std::array<int, 3> cell = cell_of(p, kEdge_m);
    for (int step = 0; step < 27; ++step) {
      if (still.contains({cell[0] + step % 3 - 1, cell[1] + step / 3 % 3 - 1, cell[2] + step / 9 - 1})) {
        return true;
      }
    }
    return false;
  }

  /// Whether a moving body was there at the time of a scan.
  [[nodiscard]] bool is_in_a_moving_box(const Point& p) const {
    for (const Box& box : boxes) {
      const Point q = box.T_sensor_body.in(box.T_world_sensor.in(p));
      if (std::abs(q[0]) < 0.5 * box.size[0] && std::abs(q[1]) < 0.5 * box.size[1] &&
          q[2] > kGround_m - 0.5 * box.size[2] && q[2] < 0.5 * box.size[2]) {
        return true;
      }
    }
    return false;
  }

  struct Box {
    Pose T_world_sensor;
    Pose T_sensor_body;
    Point size;
  };
  std::vector<Point> all;  ///< every measured point, whatever it is of
  std::set<std::array<int, 3>> still;
  std::vector<Box> boxes;
};

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
  run_and_summarise("--max-frames 2 --set registration.map.max_iterations=7 " + street().string());
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["configuration"]["registration.map.max_iterations"],
            7);
}

// A file that lists the keys of other pipelines too, with the values they have, as earlier versions printed it.
TEST_F(EndToEnd, AFileMayListWhatThePipelineDoesNotRead) {
  write_file(folder_ / "all.yaml",
             "odometry.scan_to_scan: true\nkiss_icp.voxel_size_m: 1\nego_motion.filter.tau_0_mps: 0.35\n"
             "registration.max_iterations: 7\n");
  run_and_summarise(street().string() + " --max-frames 2 --preset paper --config " + (folder_ / "all.yaml").string());
  const json configuration = json::parse(read_file(folder_ / "out" / "run.json"))["configuration"];
  EXPECT_EQ(configuration["registration.max_iterations"], 7);
  EXPECT_FALSE(configuration.contains("kiss_icp.voxel_size_m"));
}

TEST_F(EndToEnd, KeysOfTheLastReleaseAreReadWithANote) {
  write_file(folder_ / "old.yaml", "turn:\n  alpha_rad_s2: 0.25\n");
  const Outcome run =
      run_program("run " + street().string() + " --quiet --max-frames 2 --config " + (folder_ / "old.yaml").string() +
                  " --set odometry.unknown_deviation_m=0.2 --output " + (folder_ / "out").string());
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_NE(run.text.find("'odometry.unknown_deviation_m' is now 'odometry.unobservable_sigma_m'"), std::string::npos)
      << run.text;
  const json configuration = json::parse(read_file(folder_ / "out" / "run.json"))["configuration"];
  EXPECT_EQ(configuration["rotation.alpha_rad_s2"], 0.25);
  EXPECT_EQ(configuration["odometry.unobservable_sigma_m"], 0.2);
}

TEST_F(EndToEnd, ASwitchMayBringInKeys) {
  const std::string key = "ego_motion.regression.max_iterations";
  run_and_summarise("--max-frames 2 --ablation no-consensus --set " + key + "=7 " + street().string());
  EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["configuration"][key], 7);
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

TEST_F(EndToEnd, TheMapHoldsWhatStandsStillAndNothingThatMoves) {
  const TrueScene scene(street());
  // Without removal: every point, thinned alike.
  std::set<std::array<int, 3>> voxels;
  std::size_t of_bodies = 0;
  for (const Point& p : scene.all) {
    of_bodies += voxels.insert(cell_of(p, 0.1)).second && scene.is_in_a_moving_box(p) ? 1 : 0;
  }
  ASSERT_GT(of_bodies, 1000u) << "else the drive shows nothing";
  for (const std::string preset : {"default", "paper"}) {
    const std::string path = (folder_ / (preset + ".ply")).string();
    run_and_summarise(street().string() + " --preset " + preset + " --save-map " + path);
    const std::string bytes = read_file(path);
    const std::vector<float> numbers = floats_of(bytes.substr(bytes.find("end_header\n") + 11));
    const json record = json::parse(read_file(folder_ / "out" / "run.json"))["map"];
    EXPECT_EQ(record["path"], path);
    EXPECT_EQ(record["points"], numbers.size() / 3);
    ASSERT_GT(numbers.size() / 3, 50'000u) << preset;
    std::size_t in_boxes = 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Point p = {numbers[i], numbers[i + 1], numbers[i + 2]};
      ASSERT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) << preset;
      in_boxes += scene.is_in_a_moving_box(p) ? 1 : 0;
      far += scene.is_near_still(p) ? 0 : 1;
    }
    EXPECT_LT(in_boxes, of_bodies / 50) << preset;
    EXPECT_LT(far, numbers.size() / 3 / 500) << preset;
  }
}

TEST_F(EndToEnd, TheMapIsTheSameInBothFormatsAndMayLieInTheRun) {
  const std::string arguments = street().string() + " --max-frames 3 --map-voxel 0.5 --save-map ";
  run_and_summarise(arguments + (folder_ / "map.ply").string());
  const std::string ply = read_file(folder_ / "map.ply");
  const std::string points = ply.substr(ply.find("end_header\n") + 11);
  ASSERT_GT(points.size(), 12'000u);
  const fs::path inside = folder_ / "out" / "maps" / "map.pcd";
  for (int round = 0; round < 2; ++round) {  // the second one replaces the first
    run_and_summarise(arguments + inside.string() + (round == 1 ? " --threads 1" : " --threads 3"));
    const std::string pcd = read_file(inside);
    EXPECT_TRUE(pcd.ends_with("\nPOINTS " + std::to_string(points.size() / 12) + "\nDATA binary\n" + points));
    EXPECT_EQ(json::parse(read_file(folder_ / "out" / "run.json"))["map"]["path"], inside.string());
  }
  run_and_summarise(street().string() + " --max-frames 2");
  EXPECT_TRUE(json::parse(read_file(folder_ / "out" / "run.json")).at("map").is_null());
  EXPECT_FALSE(fs::exists(inside)) << "it was part of the earlier run";
  const Outcome relative = run_shell("cd '" + folder_.string() + "' && '" DYNAMIC_ICP_PROGRAM "' run " +
                                     street().string() + " --max-frames 2 --output here --save-map here.pcd");
  EXPECT_EQ(relative.status, 0) << relative.text;
  EXPECT_NE(relative.text.find("points in here.pcd"), std::string::npos) << relative.text;
  EXPECT_TRUE(fs::exists(folder_ / "here.pcd")) << "of the working directory";
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
}

TEST_F(EndToEnd, ReportsShowRunsAloneAndTogether) {
  const std::string out = (folder_ / "out").string();
  const Outcome run = run_program("run " + street().string() + " --report --quiet --output " + out);
  ASSERT_EQ(run.status, 0) << run.text;
  EXPECT_TRUE(fs::exists(folder_ / "out" / "labels" / "00001.bin")) << "what the page shows is there for the next one";
  const Outcome single = run_program("report --budget-mb 1 --frames 1-2 " + out);
  const Outcome both = run_program("report " + out + " " + out);
  if (!fs::exists(folder_ / "out" / "report.html")) {
    EXPECT_NE(run.text.find("no report.html: this program was built without the viewer"), std::string::npos)
        << run.text;
    EXPECT_EQ(single.status, 1) << single.text;
    EXPECT_NE(single.text.find("install_viewer.sh"), std::string::npos) << single.text;
    EXPECT_EQ(both.status, 1) << both.text;
    GTEST_SKIP() << "built without the viewer";
  }
  EXPECT_EQ(run.text, "");
  EXPECT_EQ(single.status, 0) << single.text;
  EXPECT_EQ(both.status, 0) << both.text;
  const std::string page = read_file(folder_ / "out" / "report.html");
  EXPECT_LT(page.size(), 4'000'000u) << "scans of 1 MB, the viewer, and the path";
  EXPECT_NE(page.find("<script type=\"text/plain\" id=\"scan-0-0\">"), std::string::npos);
  const std::string compared = read_file(folder_ / "comparison.html");
  EXPECT_NE(compared.find("\"kind\":\"comparison\""), std::string::npos);
}

TEST_F(EndToEnd, ReportRefusesWhatItCannotShow) {
  run_and_summarise(street().string() + " --save-labels");
  const std::string out = (folder_ / "out").string();
  if (run_program("report " + out).status != 0) {
    GTEST_SKIP() << "built without the viewer";
  }
  const std::tuple<std::string, int, std::string> cases[] = {
      {out + " --frames 1-", 2, "--frames is '1-'"},
      {out + " --frames 3-1", 2, "--frames is '3-1'"},
      {out + " --frames 1,,2", 2, "--frames is '1,,2'"},
      {out + " --frames 100000", 2, "scan 100000 is asked for"},
      {out + " --budget-mb 0", 2, "--budget-mb"},
      {out + " --budget-mb nan", 2, "--budget-mb is nan"},
      {out + " --threads 100000", 2, "--threads"},
      {out + " --output " + out + "/run.json", 2, "expected a file that ends in .html"},
      {out + " " + out + " --frames 1", 2, "are for the report of one run"},
      {street().string(), 1, "run.json: no such file"},
      {out + " " + street().string(), 1, "run.json: no such file"},
      {"", 2, "DIR"}};
  for (const auto& [arguments, status, text] : cases) {
    const Outcome outcome = run_program("report " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments << outcome.text;
    EXPECT_NE(outcome.text.find(text), std::string::npos) << arguments << ": " << outcome.text;
  }
}

TEST_F(EndToEnd, PlotsAreMadeFromARun) {
  run_and_summarise(street().string() + " --save-labels");
  const Outcome plots = run_program("plot " + (folder_ / "out").string());
  ASSERT_EQ(plots.status, 0) << plots.text;
  for (const char* name : {"trajectory.svg", "errors.svg", "speed.svg", "scan.svg"}) {
    EXPECT_TRUE(read_file(folder_ / "out" / "plots" / name).find("<svg") != std::string::npos) << name;
  }
  const std::string out = (folder_ / "out").string();
  const Outcome both = run_program("plot " + out + " " + out + " --output " + (folder_ / "both").string());
  ASSERT_EQ(both.status, 0) << both.text;
  EXPECT_TRUE(fs::exists(folder_ / "both" / "trajectory.svg") && fs::exists(folder_ / "both" / "errors.svg"));
  const Outcome png = run_program("plot " + out + " --format png --scale 1 --output " + (folder_ / "png").string());
  if (png.status == 0) {
    EXPECT_EQ(read_file(folder_ / "png" / "trajectory.png").substr(1, 3), "PNG");
    EXPECT_FALSE(fs::exists(folder_ / "png" / "trajectory.svg"));
  } else {
    EXPECT_EQ(png.status, 1);
    EXPECT_NE(png.text.find("built without librsvg"), std::string::npos) << png.text;
  }
  EXPECT_EQ(run_program("plot " + out + " --format gif").status, 2);
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
  EXPECT_GE(statuses.value("converged", 0) + statuses.value("degenerate", 0), 110);
}

}  // namespace
}  // namespace dynamic_icp::tests
