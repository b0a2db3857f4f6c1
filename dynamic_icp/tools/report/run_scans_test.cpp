// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_scans.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/figures/shown_scan.hpp"
#include "dynamic_icp/tools/report/scan_budget.hpp"

#include "testing/read_blob.hpp"
#include "testing/wall_drive.hpp"

namespace dynamic_icp::report {
namespace {

RunScans scans_of(const WallDrive& drive, const ScanChoice& choice, int threads = 1) {
  const runs::TestFolder folder;
  drive.write(folder);
  const runs::RunFiles run = runs::read_run(folder.path() / "run");
  std::vector<std::string> notes;
  const auto recording = figures::open_recording(run, notes);
  return keep_scans(run, std::nullopt, *recording, choice, Workers(threads));
}

std::size_t bytes_of(const RunScans& kept) {
  std::size_t bytes = (kept.map ? kept.map->blob.size() : 0) + (kept.traces ? kept.traces->blob.size() : 0);
  for (const KeptScan& scan : kept.scans) {
    bytes += scan.blob.size();
  }
  return bytes;
}

TEST(RunScans, KeepEverythingWhereThereIsRoom) {
  const WallDrive drive;
  const RunScans kept = scans_of(drive, {});
  ASSERT_EQ(kept.scans.size(), drive.frames);
  EXPECT_TRUE(kept.notes.empty()) << kept.notes.front();
  for (std::size_t k = 0; k < drive.frames; ++k) {
    EXPECT_EQ(kept.scans[k].frame, k);
    EXPECT_TRUE(kept.scans[k].whole);
    EXPECT_NEAR(kept.scans[k].dt_s, 0.1, 1e-9);
    EXPECT_EQ(kept.scans[k].points, drive.points);
    EXPECT_EQ(read_scan_blob(kept.scans[k].blob).points.size(), drive.points);
  }
}

TEST(RunScans, ShowWhatWasMeasuredAndFound) {
  for (const auto& [save_labels, sweep_s] : {std::pair(true, 0.0), {false, 0.0}, {true, 0.09}, {false, 0.09}}) {
    WallDrive drive;
    drive.save_labels = save_labels;
    drive.sweep_s = sweep_s;
    // A sweep turns the lines of sight: they were measured from elsewhere than they are seen from at the stamp.
    const double tolerance_mps = sweep_s > 0.0 ? 1.0 : 0.02;
    const RunScans kept = scans_of(drive, {});
    for (std::size_t k = 0; k < drive.frames; ++k) {
      const ReadScan scan = read_scan_blob(kept.scans[k].blob);
      std::size_t on_car = 0;
      for (std::size_t i = 0; i < scan.points.size(); ++i) {
        const Eigen::Vector3d& p = scan.points[i];
        const double along = p.x() / p.norm();  // of the line of sight
        if (scan.labels[i] == figures::kFirstObject) {
          ++on_car;
          const double t = WallDrive::seconds(k);
          EXPECT_NEAR(p.x(), WallDrive::car_x(t) - WallDrive::sensor(t).x(), scan.unit) << "at the stamp";
          EXPECT_NEAR(0.01 * scan.compensated[i], WallDrive::kCar_mps * along, tolerance_mps);
          EXPECT_NEAR(scan.doppler[i], (WallDrive::kCar_mps - WallDrive::kEgo_mps) * along, tolerance_mps);
        } else {
          ASSERT_EQ(scan.labels[i], figures::kStatic);
          EXPECT_NEAR(0.01 * scan.compensated[i], 0.0, 0.011);
          EXPECT_NEAR(scan.doppler[i], -WallDrive::kEgo_mps * along, tolerance_mps);
        }
      }
      EXPECT_EQ(on_car, drive.points / 10);
    }
  }
}

TEST(RunScans, ResidualsAreSmallOnWhatStandsStill) {
  const WallDrive drive;
  const RunScans kept = scans_of(drive, {});
  const ReadScan first = read_scan_blob(kept.scans[0].blob);
  EXPECT_EQ(std::count(first.residual.begin(), first.residual.end(), 255), std::ssize(first.residual))
      << "there is no scan before";
  const ReadScan scan = read_scan_blob(kept.scans[3].blob);
  std::size_t on_ground = 0;
  std::size_t near_ground = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    // Far from the foot of the walls, where planes are fitted across the edge.
    const bool is_ground = std::abs(scan.points[i].z() - WallDrive::kGround_m) < 0.01 && scan.points[i].x() < 15.0 &&
                           std::abs(scan.points[i].y()) < 4.0;
    on_ground += is_ground ? 1 : 0;
    near_ground += is_ground && scan.residual[i] <= 1 ? 1 : 0;
  }
  EXPECT_GT(on_ground, 300u);
  EXPECT_EQ(near_ground, on_ground) << "the distance to the plane it lies in is zero";
}

TEST(RunScans, MapIsTheStaticWorld) {
  for (const double sweep_s : {0.0, 0.09}) {
    WallDrive drive;
    drive.sweep_s = sweep_s;
    const RunScans kept = scans_of(drive, {});
    ASSERT_TRUE(kept.map);
    const std::vector<Eigen::Vector3d> map = read_map_blob(kept.map->blob);
    EXPECT_EQ(map.size(), kept.map->points);
    EXPECT_GT(map.size(), 2000u);
    for (const Eigen::Vector3d& p : map) {
      const double off = std::min({std::abs(p.z() - WallDrive::kGround_m), std::abs(p.y() - WallDrive::kSide_m),
                                   std::abs(p.x() - WallDrive::kAhead_m)});
      EXPECT_LT(off, 0.006) << p.transpose() << ": only planes that stand still, and no car";
    }
  }
}

TEST(RunScans, TracesAreWhereTheCarWas) {
  const WallDrive drive;
  const RunScans kept = scans_of(drive, {});
  ASSERT_TRUE(kept.traces);
  const std::vector<Eigen::Vector3d> traces = read_map_blob(kept.traces->blob);
  EXPECT_EQ(traces.size(), kept.traces->points);
  std::vector<std::size_t> seen(drive.frames, 0);
  for (const Eigen::Vector3d& p : traces) {
    const double frame = (p.x() - WallDrive::car_x(0.0)) / (0.1 * WallDrive::kCar_mps);
    EXPECT_NEAR(frame, std::round(frame), 0.01) << p.transpose();
    EXPECT_LT(std::abs(p.y()), 1.01);
    ++seen.at(static_cast<std::size_t>(std::lround(frame)));
  }
  for (const std::size_t count : seen) {
    EXPECT_GT(count, 50u) << "of every scan";
  }
}

TEST(RunScans, StayWithinTheBudget) {
  WallDrive drive;
  drive.frames = 20;
  drive.points = 8000;
  for (const std::size_t budget : {20'000u, 100'000u, 300'000u, 800'000u, 3'000'000u}) {
    ScanChoice choice;
    choice.budget_bytes = budget;
    const RunScans kept = scans_of(drive, choice);
    EXPECT_LE(bytes_of(kept), budget);
    const bool all_whole = std::all_of(kept.scans.begin(), kept.scans.end(), [](const KeptScan& s) { return s.whole; });
    EXPECT_TRUE(bytes_of(kept) > budget / 2 || all_whole) << "and use it: " << bytes_of(kept);
    EXPECT_EQ(kept.notes.empty(), all_whole && kept.scans.size() == drive.frames);
    for (const KeptScan& scan : kept.scans) {
      EXPECT_TRUE(scan.points > kMinPoints / 2) << scan.points << " points show no scene";
    }
  }
}

TEST(RunScans, FramesAskedForAreWholeWhateverTheyTake) {
  WallDrive drive;
  drive.frames = 8;
  ScanChoice choice;
  choice.budget_bytes = 10'000;
  choice.whole = {2, 5};
  choice.choose_whole = false;
  const RunScans kept = scans_of(drive, choice);
  ASSERT_EQ(kept.scans.size(), 2u);
  for (const KeptScan& scan : kept.scans) {
    EXPECT_TRUE(scan.whole);
    EXPECT_EQ(scan.points, drive.points);
  }
  EXPECT_EQ(kept.scans[1].frame, 5u);
  EXPECT_EQ(kept.notes.size(), 2u) << "scans are left out, and the budget is exceeded";
  choice.whole = {8};
  EXPECT_THROW(scans_of(drive, choice), UsageError);
}

TEST(RunScans, MovingPointsAreKeptBeforeOthers) {
  WallDrive drive;
  drive.frames = 3;
  drive.points = 20'000;
  ScanChoice choice;
  choice.budget_bytes = 100'000;
  choice.choose_whole = false;
  for (const KeptScan& kept : scans_of(drive, choice).scans) {
    const ReadScan scan = read_scan_blob(kept.blob);
    const auto on_car = std::count(scan.labels.begin(), scan.labels.end(), figures::kFirstObject);
    EXPECT_EQ(static_cast<std::size_t>(on_car), std::min(drive.points / 10, scan.points.size() / 2));
    EXPECT_LT(kept.points, drive.points / 2);
  }
}

TEST(RunScans, AreTheSameForAnyNumberOfThreads) {
  WallDrive drive;
  drive.points = 6000;
  ScanChoice choice;
  choice.budget_bytes = 150'000;
  const RunScans one = scans_of(drive, choice, 1);
  const RunScans four = scans_of(drive, choice, 4);
  ASSERT_EQ(one.scans.size(), four.scans.size());
  for (std::size_t k = 0; k < one.scans.size(); ++k) {
    EXPECT_EQ(one.scans[k].blob, four.scans[k].blob);
  }
  EXPECT_EQ(one.map->blob, four.map->blob);
  EXPECT_EQ(one.traces->blob, four.traces->blob);
}

}  // namespace
}  // namespace dynamic_icp::report
