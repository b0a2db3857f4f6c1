// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// A run that ended early goes on and leaves the files of an unbroken one.
#include "testing/resumed_run.hpp"

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

TEST_F(ResumedRun, EndsWithTheFilesOfAnUnbrokenOne) {
  const auto whole = unbroken();
  ASSERT_EQ(whole.count("labels/00006.bin"), 1U);
  ASSERT_EQ(whole.count("maps/map.ply"), 1U);
  EXPECT_EQ(whole.count(kCheckpointFile), 0U);
  EXPECT_EQ(whole.count(kScanRecordsFile), 0U);
  settings_.resume = true;
  for (std::size_t last = 0; last < 6; ++last) {
    run_until(last);
    settings_.command = "another";  // the run is the one that was begun
    settings_.threads = 1;
    ASSERT_TRUE(run()) << last;
    EXPECT_TRUE(last == 0 || was_told("resumed after " + std::to_string(last) + " of 6 scans"));
    settings_.command = "run";
    if (last > 0) {
      EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << last;
    }
    EXPECT_TRUE(left().empty());
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, GoesOnAgainAndAgain) {
  const auto whole = unbroken();
  settings_.resume = true;
  for (const std::size_t last : {1U, 2U, 2U, 5U}) {
    run_until(last);
  }
  ASSERT_TRUE(run());
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
}

TEST_F(ResumedRun, OfAnyMethodAndAPartOfTheScans) {
  settings_.map_file.reset();
  settings_.start = 1;
  settings_.max_frames = 4;
  for (const char* const method : {"kiss-icp", "point-to-plane"}) {
    settings_.method = method;
    settings_.config = odometry::configuration(method);
    settings_.resume = false;
    const auto whole = unbroken();
    settings_.resume = true;
    run_until(3);
    ASSERT_TRUE(run());
    EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << method;
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, AfterAStopThatKeptTheResultsSoFar) {
  const auto whole = unbroken();
  settings_.resume = true;
  settings_.checkpoint_s = 1000.0;
  std::size_t scans = 0;
  callbacks_.stop = [&] { return ++scans == 3; };
  const std::optional<RunResult> stopped = run();
  ASSERT_TRUE(stopped);
  EXPECT_TRUE(stopped->summary.stopped);
  EXPECT_EQ(stopped->summary.frames, 3U);
  EXPECT_EQ(fs::file_size(settings_.output / kScanRecordsFile), record_file_bytes(3)) << "for the one that resumes it";
  ASSERT_TRUE(run());
  EXPECT_TRUE(was_told("resumed after 3 of 6 scans"));
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
}

TEST_F(ResumedRun, WhereItIsCompleteNothingIsDone) {
  const auto whole = unbroken();
  settings_.resume = true;
  ASSERT_TRUE(run());
  const auto written = fs::last_write_time(settings_.output / "run.json");
  const std::optional<RunResult> again = run();
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_complete);
  EXPECT_EQ(fs::last_write_time(settings_.output / "run.json"), written);
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
  settings_.config = odometry::PaperConfig{};
  EXPECT_NE(refusal().find("cannot resume the run"), std::string::npos) << "of other settings";
  settings_.replace = true;
  EXPECT_FALSE(run().value().was_complete);
}

TEST_F(ResumedRun, WhatCouldNotBeMadeIsMadeWithTheLastScans) {
  const auto whole = unbroken();
  settings_.resume = true;
  for (const double checkpoint_s : {0.0, 1000.0}) {
    settings_.checkpoint_s = checkpoint_s;
    // In the way of the map: a folder of its name.
    callbacks_.frame = [&](std::size_t index, const odometry::Frame&) {
      if (index == 3) {
        fs::create_directories(left() / "maps" / "map.ply" / "in the way");
      }
    };
    const std::optional<RunResult> result = run();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->failures.size(), 1U);
    EXPECT_FALSE(result->map_points.has_value());
    callbacks_.frame = {};
    fs::remove_all(settings_.output / "maps");
    notices_.clear();
    ASSERT_TRUE(run());
    EXPECT_EQ(was_told("resumed after 5 of 6 scans"), checkpoint_s == 0.0);
    EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << checkpoint_s;
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, WithoutItTheRunBeginsAnewAndSaysSo) {
  const auto whole = unbroken();
  run_until(3);
  ASSERT_TRUE(run());
  EXPECT_TRUE(was_told("removed"));
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
  EXPECT_TRUE(left().empty());
}

TEST_F(ResumedRun, AnErrorNamesWhereItGoesOn) {
  callbacks_.frame = [&](std::size_t index, const odometry::Frame&) {
    if (index == 4) {
      throw DataError("the disk is full");
    }
  };
  EXPECT_EQ(refusal(), "the disk is full (--resume continues after 4 of 6 scans)");
}

TEST_F(ResumedRun, CancelledLeavesNothing) {
  std::size_t asked = 0;
  callbacks_.cancelled = [&] { return ++asked == 4; };
  EXPECT_FALSE(run());
  EXPECT_TRUE(left().empty());
}

TEST_F(ResumedRun, WhatCannotBeResumedIsWrongUsage) {
  settings_.resume = true;
  settings_.mcap_file = settings_.output / "run.mcap";
  EXPECT_THROW((void)run(), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::runs
