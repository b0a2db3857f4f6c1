// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_context.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::figures {
namespace {

using runs::SampleRun;
using runs::TestFolder;

RunContext context_of(const TestFolder& folder, std::optional<std::size_t> frame = std::nullopt) {
  return read_context(runs::read_run(folder.path() / "run"), frame);
}

TEST(RunContext, ComparesWithTheTruthPerFrame) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  const RunContext context = context_of(folder);
  EXPECT_TRUE(context.notes.empty()) << context.notes.front();
  ASSERT_TRUE(context.truth);
  ASSERT_EQ(context.truth->translation_error.size(), 5u);
  EXPECT_TRUE(std::isnan(context.truth->translation_error[0])) << "no motion before the first scan";
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_NEAR(context.truth->translation_error[k], 0.01, 1e-9);
    EXPECT_NEAR(context.truth->rotation_error[k], 0.0, 1e-9);
  }
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(context.truth->speed[k], 10.0, 1e-9);
    EXPECT_NEAR((context.truth->poses[k]->translation() - Eigen::Vector3d(static_cast<double>(k), 0.0, 0.0)).norm(),
                0.0, 1e-9)
        << "moved to start where the estimate starts";
  }
}

TEST(RunContext, ErrorsOverStretchesGrowWithTheirLength) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  const std::vector<StretchError> stretches = context_of(folder).truth->stretches;
  ASSERT_EQ(stretches.size(), 2u) << "the drive is 4 m long: 1 m and 2 m";
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const double length_m = static_cast<double>(k + 1);
    EXPECT_EQ(stretches[k].length_m, length_m);
    EXPECT_EQ(stretches[k].count, 4 - k) << "those that begin at the first frames";
    EXPECT_NEAR(stretches[k].translation_m, 0.01 * length_m, 1e-9) << "1 cm in each metre";
    EXPECT_NEAR(stretches[k].rotation_deg, 0.0, 1e-9);
  }
}

TEST(RunContext, WithoutStatedCovariancesNothingIsKnownOfTheConsistency) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  const RunContext context = context_of(folder);
  ASSERT_EQ(context.truth->nees_translation.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_TRUE(std::isnan(context.truth->nees_rotation[k]) && std::isnan(context.truth->nees_translation[k]));
  }
}

TEST(RunContext, ShowsTheScanAskedFor) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  const RunContext context = context_of(folder, 3);
  ASSERT_TRUE(context.scan);
  EXPECT_EQ(context.scan->title, "Scan 3");
  EXPECT_EQ(context.scan->scan.size(), 8u);
  EXPECT_EQ(context.scan->objects.size(), 1u);
  EXPECT_THROW(context_of(folder, 5), UsageError);
}

TEST(RunContext, PrefersTheScanWithMostPointsOnObjects) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  std::string objects = folder.read("run/objects.jsonl");
  const std::size_t at = objects.find("\"points\":4", objects.find("\"index\":2"));
  objects.replace(at, 10, "\"points\":5");
  folder.write("run/objects.jsonl", objects);
  EXPECT_EQ(context_of(folder).scan->title, "Scan 2");
}

TEST(RunContext, MendsTheRecordingAsTheRunDid) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  const Scan as_stored = context_of(folder, 3).scan->scan;
  std::string run = folder.read("run/run.json");
  const std::string format = R"("format":"dicp")";
  run.insert(run.find(format), R"("options":{"doppler-sign":"towards","point-scale":"0.5"},)");
  folder.write("run/run.json", run);
  const Scan corrected = context_of(folder, 3).scan->scan;
  ASSERT_EQ(corrected.size(), as_stored.size());
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    EXPECT_EQ(corrected.doppler()[i], -as_stored.doppler()[i]);
    EXPECT_EQ(corrected.points()[i], Eigen::Vector3d(0.5 * as_stored.points()[i]));
  }
}

TEST(RunContext, SaysWhatIsGone) {
  const TestFolder folder;
  SampleRun().write_run(folder);
  const RunContext context = context_of(folder);
  EXPECT_FALSE(context.scan);
  EXPECT_FALSE(context.truth);
  ASSERT_EQ(context.notes.size(), 2u);
  EXPECT_NE(context.notes[0].find("drive"), std::string::npos);
  EXPECT_NE(context.notes[1].find("ref_poses.txt"), std::string::npos);
}

TEST(RunContext, NoticesThatTheRecordingChanged) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  folder.write("drive/point_clouds/00001.bin", std::string(32, '\0'));
  const RunContext context = context_of(folder);
  EXPECT_FALSE(context.scan);
  EXPECT_TRUE(context.truth);
  ASSERT_EQ(context.notes.size(), 1u);
  EXPECT_NE(context.notes[0].find("the recording has changed"), std::string::npos);
}

TEST(RunContext, TruthOfAnotherTimeIsANote) {
  const TestFolder folder;
  SampleRun().write_recording(folder);
  SampleRun().write_run(folder);
  folder.write("other.tum", "5000.0 0 0 0 0 0 0 1\n5001.0 0 0 0 0 0 0 1\n");
  std::string run = folder.read("run/run.json");
  const std::string truth = (folder.path() / "drive/ref_poses.txt").string();
  run.replace(run.find(truth), truth.size(), (folder.path() / "other.tum").string());
  folder.write("run/run.json", run);
  const RunContext context = context_of(folder);
  EXPECT_FALSE(context.truth);
  ASSERT_EQ(context.notes.size(), 1u);
}

TEST(RunContext, RunWithoutScansHasNothingToShow) {
  const TestFolder folder;
  SampleRun sample;
  sample.frames = 0;
  sample.write_run(folder);
  const RunContext context = context_of(folder);
  EXPECT_FALSE(context.scan);
  EXPECT_FALSE(context.truth);
  EXPECT_EQ(context.notes.size(), 1u);
}

}  // namespace
}  // namespace dynamic_icp::figures
