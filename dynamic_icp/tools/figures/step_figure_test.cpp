// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/step_figure.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

#include "testing/wall_drive.hpp"
#include "testing/well_formed.hpp"

namespace dynamic_icp::figures {
namespace {

std::string drawn(const runs::TestFolder& folder, std::size_t source) {
  const runs::RunFiles run = runs::read_run(folder.path() / "run");
  std::vector<std::string> notes;
  const auto recording = open_recording(run, notes);
  const std::string document =
      step_figure(run, read_pair(run, *recording, source, Workers(1)), drawing::theme(drawing::Ground::kLight))
          .document();
  EXPECT_EQ(drawing::WellFormed::fault_of(document), "");
  EXPECT_FALSE(drawing::holds_non_finite(document));
  return document;
}

TEST(StepFigure, ShowsEveryStep) {
  const runs::TestFolder folder;
  report::WallDrive().write(folder);
  const std::string document = drawn(folder, 2);
  for (const char* text : {"Measured Doppler", "Velocity filter", "Objects", "Prediction", "Aligned"}) {
    EXPECT_NE(document.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(document.find("ground-truth velocity"), std::string::npos) << "nobody knows it";
  EXPECT_LT(document.size(), 900'000u);
}

TEST(StepFigure, ShowsTrueVelocitiesWhereTheyAreKnown) {
  const runs::TestFolder folder;
  report::WallDrive().write(folder);
  folder.write(
      "drive/objects.jsonl",
      R"({"index":2,"objects":[{"velocity_sensor":[15,0,0],"center_sensor":[21,0,0],"size":[4,2,1],"points":9}]})"
      "\n");
  EXPECT_NE(drawn(folder, 2).find("ground-truth velocity"), std::string::npos);
  EXPECT_EQ(drawn(folder, 1).find("ground-truth velocity"), std::string::npos) << "not of this scan";
}

TEST(StepFigure, TakesScansWithoutObjectsAndRefusesTheLast) {
  const runs::TestFolder folder;
  report::WallDrive drive;
  drive.frames = 2;
  drive.write(folder);
  folder.write("run/objects.jsonl",
               "{\"index\":0,\"timestamp\":100.0,\"objects\":[]}\n{\"index\":1,\"timestamp\":100.1,\"objects\":[]}\n");
  drawn(folder, 0);
  EXPECT_THROW(drawn(folder, 1), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::figures
