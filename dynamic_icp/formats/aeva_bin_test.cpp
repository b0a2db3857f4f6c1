// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/aeva_bin.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class AevaBin : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }
  fs::path path_ = fs::temp_directory_path() / ("aeva_bin_test-" + std::to_string(::getpid()) + ".bin");
};

// x = 1, y = -2, z = 0.5, reflectivity 20.5, velocity -3.25, 6 700 000 ns, line 200, byte by byte; then -57 dB.
const std::string kShortRecord(
    "\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x00\x00\xa4\x41\x00\x00\x50\xc0\xe0\x3b\x66\x00\xc8", 25);
const std::string kRecord = kShortRecord + std::string("\x00\x00\x64\xc2", 4);

void expect_record(const AevaScan& scan, std::size_t i) {
  EXPECT_EQ(scan.raw.points.at(i), Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_EQ(scan.raw.doppler.at(i), -3.25);
  EXPECT_DOUBLE_EQ(scan.raw.times.at(i), 0.0067);
  EXPECT_EQ(scan.reflectivity.at(i), 20.5F);
  EXPECT_EQ(scan.line_index.at(i), 200);
}

TEST_F(AevaBin, ReadsBothKindsOfRecords) {
  write_whole_file(path_, kRecord + kRecord);
  const AevaScan scan = read_aeva(path_, AevaRecordKind::kWithIntensity);
  ASSERT_EQ(scan.raw.points.size(), 2U);
  expect_record(scan, 1);
  EXPECT_EQ(scan.intensity, (std::vector<float>{-57.0F, -57.0F}));
  EXPECT_EQ(scan.raw.warning, "");
  EXPECT_EQ(scan.raw.stamp, Stamp{});

  write_whole_file(path_, kShortRecord + kShortRecord + kShortRecord);
  const AevaScan older = read_aeva(path_, AevaRecordKind::kWithoutIntensity);
  ASSERT_EQ(older.raw.points.size(), 3U);
  expect_record(older, 2);
  EXPECT_TRUE(older.intensity.empty());
}

TEST_F(AevaBin, TimesMayLieBeforeTheStamp) {
  std::string record = kRecord;
  record.replace(20, 4, "\xff\xff\xff\xff");
  write_whole_file(path_, record);
  EXPECT_DOUBLE_EQ(read_aeva(path_, AevaRecordKind::kWithIntensity).raw.times.at(0), -1e-9);
}

TEST_F(AevaBin, LeavesOutAnIncompleteRecordAndSaysSo) {
  write_whole_file(path_, kRecord + kRecord.substr(0, 28));
  const AevaScan scan = read_aeva(path_, AevaRecordKind::kWithIntensity);
  ASSERT_EQ(scan.raw.points.size(), 1U);
  expect_record(scan, 0);
  EXPECT_NE(scan.raw.warning.find(path_.string() + ": 28 bytes after record 1"), std::string::npos) << scan.raw.warning;
}

TEST_F(AevaBin, AnEmptyFileIsAnEmptyScanWithAWarning) {
  write_whole_file(path_, "");
  const AevaScan scan = read_aeva(path_, AevaRecordKind::kWithoutIntensity);
  EXPECT_TRUE(scan.raw.points.empty() && scan.raw.times.empty());
  EXPECT_FALSE(scan.raw.warning.empty());
  EXPECT_THROW(read_aeva(path_.string() + ".missing", AevaRecordKind::kWithIntensity), DataError);
}

TEST_F(AevaBin, WritesTheSameBytes) {
  const AevaRecord record{1.0F, -2.0F, 0.5F, 20.5F, -3.25F, 6'700'000, 200, -57.0F};
  write_aeva(path_, std::array{record, record});
  EXPECT_EQ(read_whole_file(path_), kRecord + kRecord);
  write_aeva(path_, {});
  EXPECT_EQ(read_whole_file(path_), "");
}

}  // namespace
}  // namespace dynamic_icp::formats
