// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/worst_frames.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::report {
namespace {

runs::RunFiles run_with(const std::vector<const char*>& statuses) {
  runs::RunFiles run;
  for (const char* status : statuses) {
    run.frames.emplace_back().status = status;
  }
  return run;
}

using Places = std::vector<std::size_t>;

TEST(WorstFrames, AreThoseWithTheLargestErrorWhateverTheirStatus) {
  const runs::RunFiles run = run_with({"ok", "lost", "ok", "ok"});
  figures::RunTruth truth;
  truth.translation_error = {std::numeric_limits<double>::quiet_NaN(), 0.2, 0.1, 0.3};
  EXPECT_EQ(worst_frames(run, truth, 2), (Places{3, 1}));
  EXPECT_EQ(worst_frames(run, truth, 9), (Places{3, 1, 2})) << "of the first one no error is known";
}

TEST(WorstFrames, WithoutGroundTruthAreTheLostAndThenTheDegenerateOnes) {
  const runs::RunFiles run = run_with({"ok", "degenerate", "ok", "lost", "lost"});
  EXPECT_EQ(worst_frames(run, std::nullopt, 9), (Places{3, 4, 1}));
  EXPECT_EQ(worst_frames(run_with({"ok", "ok"}), std::nullopt, 9), Places{});
}

}  // namespace
}  // namespace dynamic_icp::report
