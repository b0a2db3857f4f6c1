// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/file_kind.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

/// A header of a tar file with one member.
std::string tar_header() {
  std::string header(512, '\0');
  header.replace(0, 7, "a/b.bin");
  header.replace(100, 7, "0000644");
  header.replace(257, 6, std::string("ustar\0", 6));
  return header;
}

TEST(FileKindOf, IsToldByTheFirstBytes) {
  const std::vector<std::pair<std::string, FileKind>> files = {
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 16\n", FileKind::kLfsPointer},
      {"PK\x03\x04 and so on", FileKind::kZip},
      {"\x1F\x8B\x08\x08 \x10\x20\x30\x30\x03name", FileKind::kUnknown},  // level 0x30
      {std::string("\x1F\x8B\x08\x08\x10\x20\x30\x40\x02\x03name", 14), FileKind::kGzip},
      {"\x28\xB5\x2F\xFD...", FileKind::kZstd},
      {"7z\xBC\xAF\x27\x1C...", FileKind::kSevenZip},
      {tar_header(), FileKind::kTar},
      {"\x93NUMPY\x01", FileKind::kNpy},
      {"\x89\x4D\x43\x41\x50\x30\x0D\x0A...", FileKind::kMcap},
      {"#ROSBAG V2.0\n...", FileKind::kRosBag},
      {"#ROSBAG V1.2\n...", FileKind::kOldRosBag},
      {"#ROSRECORD V1.1\n...", FileKind::kOldRosBag},
      {std::string("SQLite format 3\0...", 19), FileKind::kSqlite},
      {"ply\nformat", FileKind::kPly},
      {"ply\r\nformat", FileKind::kPly},
      {"# .PCD v0.7", FileKind::kPcd},
      {"VERSION .7\n", FileKind::kPcd},
      {"FIELDS x y z\n", FileKind::kPcd},
      {"", FileKind::kUnknown},
      {"PK", FileKind::kUnknown},
      {"plywood", FileKind::kUnknown},
      {std::string(512, '\0'), FileKind::kUnknown},
      {tar_header().substr(0, 260), FileKind::kUnknown},
  };
  for (const auto& [content, kind] : files) {
    EXPECT_EQ(kind_of(content), kind) << content.substr(0, 20);
  }
}

// x = 1, y = -2 and so on, and a coordinate that shares two bytes with the mark of gzip.
TEST(FileKindOf, PointsHaveNoKind) {
  EXPECT_EQ(kind_of(std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0", 8)), FileKind::kUnknown);
  EXPECT_EQ(kind_of(std::string("\x1f\x8b\x08\x41\x00\x00\x00\xc0\x00\x00\x00\x00", 12)), FileKind::kUnknown);
}

TEST(FileKindOf, OtherKindsThanExpectedAreRefusedWithASentence) {
  EXPECT_NO_THROW(refuse_other_kind("a.bin", "1234", FileKind::kUnknown));
  EXPECT_NO_THROW(refuse_other_kind("a.npz", "PK\x03\x04", FileKind::kZip));
  EXPECT_NO_THROW(refuse_other_kind("a.npz", "1234", FileKind::kZip));
  try {
    refuse_other_kind("folder/a.bin", "PK\x03\x04", FileKind::kUnknown);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_STREQ(error.what(), "folder/a.bin: is a zip archive; unpack it first");
  }
  EXPECT_THROW(refuse_other_kind("a.npz", "\x93NUMPY", FileKind::kZip), DataError);
}

TEST(FileKindOf, FilesAreOpenedForIt) {
  const fs::path path = fs::temp_directory_path() / ("file_kind_test-" + std::to_string(::getpid()));
  write_whole_file(path, "PK\x03\x04");
  EXPECT_EQ(kind_of_file(path), FileKind::kZip);
  write_whole_file(path, "");
  EXPECT_EQ(kind_of_file(path), FileKind::kUnknown);
  fs::remove(path);
  try {
    (void)kind_of_file(path);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string() + ": cannot read: No such file"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
