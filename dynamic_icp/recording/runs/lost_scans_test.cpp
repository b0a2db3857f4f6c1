// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/lost_scans.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::runs {
namespace {

using odometry::FrameStatus;

odometry::Frame frame(FrameStatus status, double time_s, std::size_t points, std::size_t used) {
  odometry::Frame result;
  result.status = status;
  result.stamp = Stamp{static_cast<std::int64_t>(time_s * 1e9)};
  result.points = points;
  result.points_used = used;
  return result;
}

/// The failure of a run whose first scan is fine and whose others are these, `interval_s` apart.
std::string failure(const std::vector<FrameStatus>& others, std::size_t points, std::size_t used,
                    double interval_s = 0.1, const Scan::Dropped& dropped = {}) {
  LostScans lost;
  lost.add(scan_record(frame(FrameStatus::kFirst, 0.0, points, used)));
  for (std::size_t i = 0; i < others.size(); ++i) {
    odometry::Frame next = frame(others[i], interval_s * static_cast<double>(i + 1), points, used);
    next.dropped = dropped;
    lost.add(scan_record(next));
  }
  return lost.failure().value_or("none");
}

TEST(LostScans, ARunFailsWhenMoreThanHalfOfItsScansAreLost) {
  using enum FrameStatus;
  EXPECT_EQ(LostScans().failure(), std::nullopt);
  EXPECT_EQ(failure({}, 9000, 9000), "none");
  EXPECT_EQ(failure({kLost, kConverged, kLost}, 9000, 9000), "none") << "2 of 4";
  EXPECT_TRUE(failure({kLost, kConverged, kLost, kLost}, 9000, 9000).starts_with("ODOMETRY FAILED on 3 of 5 scans: "));
  EXPECT_EQ(failure({kDegenerate, kAmbiguous, kDegenerate, kIterationLimit}, 9000, 9000), "none")
      << "degenerate is not lost";
}

TEST(LostScans, NamesTheCauseOfMostOfThem) {
  using enum FrameStatus;
  EXPECT_EQ(failure({kLost, kLost, kTimeGap}, 41, 41),
            "ODOMETRY FAILED on 3 of 4 scans: 41 points a scan give no planes");
  EXPECT_NE(failure({kTooFewCorrespondences, kTooFewCorrespondences}, 41, 41).find("41 points a scan are too few"),
            std::string::npos);
  EXPECT_NE(failure({kLost, kLost}, 9000, 8000).find("with 8000 points a scan, scans do not fit"), std::string::npos);
  EXPECT_NE(failure({kTimeGap, kTimeGap}, 9000, 9000, 100.0).find("100 s from scan to scan are too long"),
            std::string::npos);
  EXPECT_NE(failure({kTooSoon, kTooSoon}, 9000, 9000, 1e-4).find("0.0001 s from scan to scan are no time"),
            std::string::npos);
}

TEST(LostScans, SaysWhatBecameOfThePoints) {
  using enum FrameStatus;
  Scan::Dropped dropped;
  dropped.out_of_range = 8950;
  dropped.flagged = 10;
  const std::string text = failure({kTooFewPoints, kTooFewPoints}, 9000, 5, 0.1, dropped);
  EXPECT_NE(text.find("5 usable points a scan of 9000 are too few"), std::string::npos) << text;
  EXPECT_NE(text.find("out of range"), std::string::npos) << text;
}

}  // namespace
}  // namespace dynamic_icp::runs
