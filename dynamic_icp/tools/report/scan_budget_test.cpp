// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/scan_budget.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace dynamic_icp::report {
namespace {

using Counts = std::vector<std::size_t>;

TEST(ScanBudget, EvenShareIsTheLargestThatFits) {
  EXPECT_EQ(even_share(Counts{10, 10, 10}, 15), 5u);
  EXPECT_EQ(even_share(Counts{2, 10, 10}, 16), 7u) << "what a small scan leaves goes to the others";
  EXPECT_EQ(even_share(Counts{2, 3, 4}, 100), 4u);
  EXPECT_EQ(even_share(Counts{5}, 0), 0u);
  // Against trying out every share.
  const Counts points = {3, 50, 7, 22, 9, 41, 41, 0, 15};
  for (std::size_t total = 0; total < 250; total += 7) {
    std::size_t best = 0;
    for (std::size_t share = 0; share <= 50; ++share) {
      std::size_t sum = 0;
      for (const std::size_t n : points) {
        sum += std::min(n, share);
      }
      best = sum <= total ? share : best;
    }
    EXPECT_EQ(even_share(points, total), best) << total;
  }
}

TEST(ScanBudget, SpreadFramesHoldBothEnds) {
  EXPECT_EQ(spread_frames(10, 4), (Counts{0, 3, 6, 9}));
  EXPECT_EQ(spread_frames(3, 10), (Counts{0, 1, 2}));
  EXPECT_EQ(spread_frames(1, 10), (Counts{0}));
  EXPECT_EQ(spread_frames(5, 1), (Counts{0}));
  EXPECT_TRUE(spread_frames(0, 3).empty());
  const Counts many = spread_frames(100'000, 777);
  EXPECT_EQ(many.size(), 777u);
  EXPECT_TRUE(std::is_sorted(many.begin(), many.end()));
  EXPECT_EQ(many.back(), 99'999u);
}

TEST(ScanBudget, ThinsPointsFirstThenScans) {
  const Counts points(100, 10'000);
  const KeptFrames all = kept_frames(points, Counts{}, 300'000);
  EXPECT_EQ(all.frames.size(), 100u);
  EXPECT_EQ(all.points, 3000u);
  const KeptFrames some = kept_frames(points, Counts{}, 100'000);
  EXPECT_EQ(some.frames.size(), 50u);
  EXPECT_GE(some.points, kMinPoints);
  EXPECT_LE(some.frames.size() * some.points, 100'000u);
  const Counts small(100, 500);
  EXPECT_EQ(kept_frames(small, Counts{}, 50'000).frames.size(), 100u) << "small scans are no reason to leave any out";
}

TEST(ScanBudget, WholeFramesAreAlwaysThere) {
  const Counts points(100, 10'000);
  const KeptFrames kept = kept_frames(points, Counts{13, 14, 98}, 20'000);
  EXPECT_TRUE(std::is_sorted(kept.frames.begin(), kept.frames.end()));
  for (const std::size_t frame : {13u, 14u, 98u}) {
    EXPECT_EQ(std::count(kept.frames.begin(), kept.frames.end(), frame), 1);
  }
  EXPECT_EQ(kept.frames.size(), 13u);
  EXPECT_EQ(kept_frames(points, Counts{5}, 0).frames, (Counts{5}));
}

TEST(ScanBudget, TellingFramesAreThoseThatWentWrong) {
  runs::RunFiles run;
  run.frames.resize(20);
  run.objects.resize(20);
  for (runs::FrameRow& frame : run.frames) {
    frame.status = "ok";
  }
  run.frames[15].status = "degenerate";
  run.frames[16].status = "degenerate";
  run.frames[18].status = "lost";
  run.objects[4].push_back({.id = 1, .points = 30.0});
  figures::RunTruth truth;
  truth.translation_error.assign(20, 0.01);
  truth.translation_error[0] = std::numeric_limits<double>::quiet_NaN();
  truth.translation_error[7] = 0.5;
  truth.rotation_error.assign(20, 0.01);
  truth.rotation_error[8] = 0.5;
  EXPECT_EQ(informative_frames(run, truth), (Counts{0, 4, 7, 8, 10, 15, 18}));
  EXPECT_EQ(informative_frames(run, std::nullopt), (Counts{0, 4, 10, 15, 18}));
  EXPECT_TRUE(informative_frames({}, std::nullopt).empty());
}

}  // namespace
}  // namespace dynamic_icp::report
