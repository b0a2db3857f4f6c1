// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// One simulated drive in several layouts, each found by itself, gives the same trajectory.
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace dynamic_icp::tests {
namespace {

using nlohmann::json;

class Conversion : public ProgramTest {
 protected:
  Outcome convert(const fs::path& input, const std::string& to, const std::string& more = "") {
    return run_program("convert " + input.string() + " --to " + to + " --output " + (folder_ / to).string() + " " +
                       more);
  }
  /// The rows of the trajectory of a run.
  std::vector<std::vector<std::string>> trajectory(const fs::path& input, const std::string& more = "") {
    const fs::path out = folder_ / ("run-" + std::to_string(++runs_));
    const Outcome outcome = run_program("run --quiet " + input.string() + " --output " + out.string() + " " + more);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    run_ = json::parse(read_file(out / "run.json"));
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(read_file(out / "trajectory.tum"));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      rows.emplace_back();
      for (std::string word; words >> word;) {
        rows.back().push_back(word);
      }
    }
    return rows;
  }
  static void expect_same(const std::vector<std::vector<std::string>>& a,
                          const std::vector<std::vector<std::string>>& b, double tolerance, bool same_stamps) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].size(), 8u);
      if (same_stamps) {
        EXPECT_EQ(a[i][0], b[i][0]);
      }
      for (std::size_t k = 1; k < 8; ++k) {
        EXPECT_NEAR(std::stod(a[i][k]), std::stod(b[i][k]), tolerance) << "scan " << i << " number " << k;
      }
    }
  }

  json run_;
  int runs_ = 0;
};

TEST_F(Conversion, TheSameTrajectoryInEveryLayout) {
  const std::vector<std::vector<std::string>> expected = trajectory(street());
  ASSERT_GE(expected.size(), 5u);
  const double path_m = std::hypot(std::stod(expected.back()[1]), std::stod(expected.back()[2]));
  EXPECT_GT(path_m, 3.0) << "nothing is shown by a sensor that stands still";
  for (const std::string to : {"npz", "pcd", "ply", "mcap", "dicp"}) {
    const Outcome outcome = convert(street(), to);
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find("left out"), std::string::npos) << outcome.text;
    expect_same(trajectory(folder_ / to), expected, 0.0, true);
    EXPECT_EQ(run_["input"]["format"], to);
    EXPECT_EQ(run_["ground_truth"], (folder_ / to / (to == "mcap" ? "recording.mcap" : "ref_poses.txt")).string());
  }
  // Back again, bit by bit.
  fs::rename(folder_ / "dicp", folder_ / "first");
  ASSERT_EQ(convert(folder_ / "ply", "dicp").status, 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "first" / "point_clouds")) {
    EXPECT_EQ(read_file(entry.path()), read_file(folder_ / "dicp" / "point_clouds" / entry.path().filename()));
    EXPECT_EQ(read_file(entry.path()), read_file(street() / "point_clouds" / entry.path().filename()));
  }
}

TEST_F(Conversion, AnAevaScenesDriveIsTheSameDrive) {
  for (const std::string layout : {"dicp", "aevascenes"}) {
    const Outcome made = run_program("simulate street --output " + (folder_ / layout).string() + " --layout " + layout +
                                     " --frames 6 --seed 3 --quiet");
    ASSERT_EQ(made.status, 0) << made.text;
  }
  // Times are rounded to nanoseconds there and to float32 here. Preset `paper` does not look at
  // lines, which only AevaScenes has.
  const std::vector<std::vector<std::string>> expected = trajectory(folder_ / "dicp", "--preset paper");
  expect_same(trajectory(folder_ / "aevascenes", "--preset paper"), expected, 1e-4, false);
  EXPECT_EQ(run_["input"]["format"], "aevascenes");
  ASSERT_EQ(convert(folder_ / "aevascenes", "npz").status, 0);
  expect_same(trajectory(folder_ / "npz", "--preset paper"), expected, 1e-4, false);
}

TEST_F(Conversion, SomeScansOnly) {
  ASSERT_EQ(convert(street(), "npz", "--start 1 --max-frames 2 --quiet").status, 0);
  EXPECT_EQ(trajectory(folder_ / "npz").size(), 2u);
  const json record = json::parse(read_file(folder_ / "npz" / "conversion.json"));
  EXPECT_EQ(record["start"], 1);
  EXPECT_EQ(record["scans"], 2);
}

TEST_F(Conversion, ProgressCountsEachScanOnce) {
  const Outcome outcome = convert(street(), "npz", "--max-frames 10");
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("convert: 5 of 10\n"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("convert: 10 of 10\n"), std::string::npos) << outcome.text;
}

TEST_F(Conversion, EarlierResultsStayUnlessForced) {
  ASSERT_EQ(convert(street(), "pcd", "--max-frames 2").status, 0);
  const Outcome again = convert(street(), "pcd", "--max-frames 1");
  EXPECT_EQ(again.status, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
  EXPECT_EQ(convert(street(), "pcd", "--max-frames 1 --force").status, 0);
  EXPECT_EQ(json::parse(read_file(folder_ / "pcd" / "conversion.json"))["scans"], 1);
}

TEST_F(Conversion, NothingIsLeftOfAFailure) {
  const fs::path broken = folder_ / "broken";
  fs::create_directories(broken);
  for (const char* name : {"1.pcd", "2.pcd"}) {
    write_file(broken / name, "FIELDS x y z v\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 4\n");
  }
  write_file(broken / "2.pcd", "FIELDS x y z v\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 9\nDATA ascii\n1 2 3 4\n");
  const Outcome outcome = convert(broken, "npz");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.text.find("2.pcd: 9 points of 4 numbers each"), std::string::npos) << outcome.text;
  EXPECT_FALSE(fs::exists(folder_ / "npz"));
  EXPECT_EQ(convert(street(), "hercules").status, 2);
  EXPECT_EQ(convert(street(), "npz", "--start 1000").status, 2);
  EXPECT_EQ(convert(street(), "npz", "--field doppler").status, 2);
  EXPECT_EQ(convert(broken, "npz", "--field speed=v").status, 2);
  EXPECT_EQ(convert(broken, "npz", "--field doppler=w").status, 1);
}

}  // namespace
}  // namespace dynamic_icp::tests
