// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class XyzdBin : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }
  void write(const std::string& bytes) { write_whole_file(path_, bytes); }
  fs::path path_ = fs::temp_directory_path() / ("xyzd_bin_test-" + std::to_string(::getpid()) + ".bin");
};

// x = 1, y = -2, z = 0.5, Doppler = -3.25, byte by byte.
const std::string kXyzdRecord("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x00\x00\x50\xc0", 16);

TEST_F(XyzdBin, ReadsLittleEndianRecords) {
  write(kXyzdRecord + kXyzdRecord);
  const RawScan raw = read_xyzd(path_);
  ASSERT_EQ(raw.points.size(), 2u);
  EXPECT_EQ(raw.points[1], Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_EQ(raw.doppler[1], -3.25);
  EXPECT_TRUE(raw.warning.empty());
  EXPECT_TRUE(raw.times.empty());
}

TEST_F(XyzdBin, LeavesOutAnIncompleteRecordAndSaysSo) {
  write(kXyzdRecord + kXyzdRecord.substr(0, 7));
  const RawScan raw = read_xyzd(path_);
  EXPECT_EQ(raw.points.size(), 1u);
  EXPECT_NE(raw.warning.find(path_.string()), std::string::npos);
  EXPECT_NE(raw.warning.find("7 bytes after record 1"), std::string::npos) << raw.warning;
}

TEST_F(XyzdBin, AnEmptyFileIsAnEmptyScanWithAWarning) {
  write("");
  const RawScan raw = read_xyzd(path_);
  EXPECT_TRUE(raw.points.empty());
  EXPECT_FALSE(raw.warning.empty());
}

TEST_F(XyzdBin, WritesTheSameBytes) {
  RawScan scan;
  scan.points.assign(2, {1.0, -2.0, 0.5});
  scan.doppler.assign(2, -3.25);
  write_xyzd(path_, scan);
  EXPECT_EQ(read_whole_file(path_), kXyzdRecord + kXyzdRecord);
  write_xyzd(path_, {});
  EXPECT_EQ(read_whole_file(path_), "");
  scan.doppler.pop_back();
  EXPECT_THROW(write_xyzd(path_, scan), std::invalid_argument);
  scan.doppler.push_back(0.0);
  EXPECT_THROW(write_xyzd(path_.string() + ".missing/a.bin", scan), DataError);
}

TEST_F(XyzdBin, NamesWhatIsNotData) {
  const auto message = [&](const std::string& content) -> std::string {
    write(content);
    try {
      read_xyzd(path_);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 16\n").find("Git LFS pointer"),
            std::string::npos);
  EXPECT_NE(message(std::string("PK\x03\x04") + kXyzdRecord).find("zip archive"), std::string::npos);
  EXPECT_THROW(read_xyzd(path_.string() + ".missing"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::formats
