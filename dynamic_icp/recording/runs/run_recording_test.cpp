// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"

#include "testing/wall_drive.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

/// A recording of a few scans, and where its run goes.
class RunRecording : public ::testing::Test {
 protected:
  RunRecording() {
    report::WallDrive().write(folder_);
    fs::remove_all(folder_.path() / "run");  // of the hand-made run nothing is wanted
    settings_.output = folder_.path() / "out";
    settings_.threads = 1;
  }

  [[nodiscard]] Recording recording() const { return {folder_.path() / "drive", {}}; }

  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  TestFolder folder_;
  RunSettings settings_;
};

TEST_F(RunRecording, WritesARunThatCanBeRead) {
  settings_.save_labels = true;
  settings_.map_file = settings_.output / "map.ply";
  settings_.command = "by the library";
  std::vector<std::size_t> done;
  RunCallbacks callbacks;
  callbacks.progress = [&](std::size_t scans, std::size_t total) {
    EXPECT_EQ(total, 6U);
    done.push_back(scans);
  };
  std::vector<odometry::Frame> frames;
  callbacks.frame = [&](std::size_t index, const odometry::Frame& frame) {
    EXPECT_EQ(index, frames.size());
    frames.push_back(frame);
  };
  const std::optional<RunResult> result = run_recording(recording(), settings_, callbacks);
  ASSERT_TRUE(result);
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(result->summary.frames, 6U);
  EXPECT_EQ(result->summary.accuracy.matched, 6U);
  EXPECT_LT(result->summary.accuracy.rte_rmse_m, 0.1) << "the points are exact";
  EXPECT_NEAR(result->period_s, 0.1, 1e-9);
  EXPECT_GT(result->map_points, 0U);
  EXPECT_TRUE(result->failures.empty());

  const RunFiles files = read_run(settings_.output);
  EXPECT_EQ(files.frames.size(), 6U);
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[5].labels, read_labels(files, 5, 3000));
  EXPECT_TRUE(read_labels(files, 5, 3000));
  EXPECT_EQ(text_of(files.run, "command"), "by the library");
  EXPECT_EQ(text_of(files.run, "map.file_in_run"), "map.ply");
  EXPECT_EQ(number_of(files.run, "map.points"), static_cast<double>(*result->map_points));
  EXPECT_TRUE(fs::exists(settings_.output / "map.ply"));
}

TEST_F(RunRecording, CancelledLeavesNothingBehind) {
  std::size_t asked = 0;
  RunCallbacks callbacks;
  callbacks.cancelled = [&] { return ++asked == 3; };
  settings_.map_file = folder_.path() / "map.ply";
  EXPECT_FALSE(run_recording(recording(), settings_, callbacks));
  EXPECT_EQ(asked, 3U);
  EXPECT_EQ(entries(), 1U) << "more than the recording";
}

TEST_F(RunRecording, CancelledKeepsTheEarlierRun) {
  settings_.max_frames = 2;
  ASSERT_TRUE(run_recording(recording(), settings_));
  const std::string before = folder_.read("out/frames.jsonl");
  settings_.replace = true;
  RunCallbacks callbacks;
  callbacks.cancelled = [] { return true; };
  EXPECT_FALSE(run_recording(recording(), settings_, callbacks));
  EXPECT_EQ(folder_.read("out/frames.jsonl"), before);
  EXPECT_EQ(entries(), 2U);
}

TEST_F(RunRecording, StoppedKeepsTheResultsSoFar) {
  std::size_t asked = 0;
  RunCallbacks callbacks;
  callbacks.stop = [&] { return ++asked == 3; };
  const std::optional<RunResult> result = run_recording(recording(), settings_, callbacks);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->summary.stopped);
  EXPECT_EQ(result->summary.frames, 3U);
  EXPECT_EQ(result->scans_selected, 6U);
  const RunFiles files = read_run(settings_.output);
  EXPECT_EQ(files.frames.size(), 3U);
  EXPECT_NE(folder_.read("out/summary.json").find("\"stopped\": true"), std::string::npos);
  EXPECT_NE(folder_.read("out/run.json").find("\"stopped\": true"), std::string::npos);
}

TEST_F(RunRecording, IsNotAskedToStopAfterItsLastScan) {
  std::size_t asked = 0;
  RunCallbacks callbacks;
  callbacks.stop = [&] { return ++asked == 6; };
  const std::optional<RunResult> result = run_recording(recording(), settings_, callbacks);
  ASSERT_TRUE(result);
  EXPECT_EQ(asked, 5U);
  EXPECT_FALSE(result->summary.stopped);
  EXPECT_NE(folder_.read("out/summary.json").find("\"stopped\": false"), std::string::npos);
}

// By the clock of another drive.
constexpr const char* kOtherTruth = "5000.0 0 0 0 0 0 0 1\n5000.1 1 0 0 0 0 0 1\n5000.2 2 0 0 0 0 0 1\n";

TEST_F(RunRecording, RefusesGroundTruthOfAnotherDriveBeforeTheFirstScan) {
  folder_.write("other.tum", kOtherTruth);
  settings_.ground_truth = folder_.path() / "other.tum";
  RunCallbacks callbacks;
  callbacks.progress = [](std::size_t, std::size_t) { FAIL() << "a scan was processed"; };
  try {
    run_recording(recording(), settings_, callbacks);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("other.tum: does not fit the scans"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(settings_.output));
}

TEST_F(RunRecording, AddsFilesOfTheCaller) {
  RunCallbacks callbacks;
  callbacks.add_files = [&](const fs::path& folder) {
    EXPECT_EQ(read_run(folder).frames.size(), 6U) << "the files of the run are there already";
    EXPECT_FALSE(fs::exists(settings_.output)) << "but have not appeared";
    std::ofstream(folder / "report.html") << "page";
  };
  ASSERT_TRUE(run_recording(recording(), settings_, callbacks));
  EXPECT_EQ(folder_.read("out/report.html"), "page");
}

TEST_F(RunRecording, KeepsTheRunWhenWhatIsAddedFails) {
  RunCallbacks callbacks;
  callbacks.add_files = [](const fs::path& folder) {
    throw std::runtime_error("no page in " + (folder / "x").string());
  };
  const std::optional<RunResult> result = run_recording(recording(), settings_, callbacks);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->failures, (std::vector<std::string>{"no page in " + (settings_.output / "x").string()}));
  EXPECT_EQ(read_run(settings_.output).frames.size(), 6U);
}

TEST_F(RunRecording, RefusesWhatCannotBeMeantBeforeItWrites) {
  const auto refusal = [&] {
    try {
      run_recording(recording(), settings_);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("no refusal");
  };
  settings_.start = 6;
  EXPECT_EQ(refusal(), "the first scan is to be 6, expected 0 to 5: the recording has 6 scans");
  settings_.start = 0;
  settings_.map_file = settings_.output / "map.ply";
  settings_.method = "kiss-icp";
  EXPECT_NE(refusal().find("kiss-icp does not: it makes no map"), std::string::npos) << refusal();
  EXPECT_EQ(entries(), 1U);
}

TEST_F(RunRecording, RefusesARecordingWithoutPoints) {
  for (int k = 1; k <= 6; ++k) {
    folder_.write(fmt::format("drive/point_clouds/{:05}.bin", k), std::string(64, '\0'));
  }
  EXPECT_THROW(run_recording(recording(), settings_), DataError);
  EXPECT_EQ(entries(), 1U);
}

}  // namespace
}  // namespace dynamic_icp::runs
