// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/scan_record.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/sample_run.hpp"

namespace dynamic_icp::runs {
namespace {

odometry::Frame recorded_frame(int k) {
  odometry::Frame frame;
  frame.status = k % 2 == 0 ? odometry::FrameStatus::kConverged : odometry::FrameStatus::kLost;
  frame.stamp = Stamp{1'700'000'000'000'000'001 + k};
  frame.T_world_sensor = Eigen::Translation3d(0.1 * k, 1e-300, -3.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  if (k % 2 == 0) {
    frame.alignment.status = registration::AlignStatus::kConverged;
    frame.alignment.iterations = 3 + k;
    frame.alignment.covariance = Matrix6d::Constant(1.0 / 3.0 + k);
  }
  frame.points = 70'000;
  frame.points_used = 5'000;
  frame.dropped.flagged = 7;
  frame.dynamic_candidates = 30;
  frame.dynamic_clustered = 20;
  frame.dynamic_refined = 10;
  frame.times.total_ms = 12.5;
  return frame;
}

TEST(ScanRecord, ComesBackFromTheFileBitForBit) {
  const TestFolder folder;
  const std::filesystem::path file = folder.path() / kScanRecordsFile;
  std::string bytes;
  constexpr int kScans = 300;  // several blocks
  for (int k = 0; k < kScans; ++k) {
    bytes += record_bytes(scan_record(recorded_frame(k)));
  }
  ASSERT_EQ(bytes.size(), record_file_bytes(kScans)) << "as many bytes for each, with and without a covariance";
  formats::write_bytes(file, bytes);
  int k = 0;
  const std::size_t count = for_each_record(file, [&](const ScanRecord& record) {
    const odometry::Frame frame = recorded_frame(k++);
    EXPECT_EQ(record.status, frame.status);
    EXPECT_EQ(record.stamp, frame.stamp);
    EXPECT_EQ(record.T_world_sensor.matrix(), frame.T_world_sensor.matrix());
    EXPECT_EQ(record.covariance, frame.alignment.covariance);
    EXPECT_EQ(record.is_aligned, frame.alignment.status != registration::AlignStatus::kNotRun);
    EXPECT_EQ(record.iterations, frame.alignment.iterations);
    EXPECT_EQ(record.points, frame.points);
    EXPECT_EQ(record.points_used, frame.points_used);
    EXPECT_EQ(record.dropped.flagged, 7U);
    EXPECT_EQ(record.dynamic_candidates, 30U);
    EXPECT_EQ(record.dynamic_clustered, 20U);
    EXPECT_EQ(record.dynamic_refined, 10U);
    EXPECT_EQ(record.total_ms, 12.5);
  });
  EXPECT_EQ(count, static_cast<std::size_t>(kScans));
  formats::write_bytes(file, "");
  EXPECT_EQ(for_each_record(file, [](const ScanRecord&) { FAIL(); }), 0U) << "a run that ended before its first scan";
}

TEST(ScanRecord, DamageIsToldWithTheNameOfTheFile) {
  const TestFolder folder;
  const std::filesystem::path file = folder.path() / kScanRecordsFile;
  const std::string bytes = record_bytes(scan_record(recorded_frame(0))) + record_bytes(scan_record(recorded_frame(1)));
  const auto fault = [&](const std::string& damaged) -> std::string {
    formats::write_bytes(file, damaged);
    try {
      for_each_record(file, [](const ScanRecord&) {});
    } catch (const DataError& error) {
      return error.what();
    }
    return "none";
  };
  ASSERT_EQ(fault(bytes), "none");
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 16);
    EXPECT_NE(fault(damaged).find("checkpoint.scans: record "), std::string::npos) << at << ": " << fault(damaged);
  }
  EXPECT_NE(fault(bytes.substr(0, bytes.size() - 1)).find("expected a multiple of"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::runs
