// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/record_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class RecordFiles : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(path_); }

  /// All the blocks, one after the other.
  std::string content(std::size_t record_bytes) {
    RecordFile file(path_, record_bytes);
    std::string bytes;
    for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
      EXPECT_EQ(block.size() % record_bytes, 0U);
      bytes += block;
    }
    EXPECT_EQ(bytes.size(), file.records() * record_bytes);
    EXPECT_TRUE(file.next().empty()) << "stays at the end";
    return bytes;
  }

  std::string fault(std::size_t record_bytes = 4) {
    try {
      content(record_bytes);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path path_ = fs::temp_directory_path() / ("record_file_test-" + std::to_string(::getpid()));
};

TEST_F(RecordFiles, BlocksAreTheWholeFile) {
  std::string bytes;
  for (int i = 0; i < 300'000; ++i) {
    bytes.push_back(static_cast<char>(i * 7 + i / 251));
  }
  write_whole_file(path_, bytes);
  for (const std::size_t size : {1U, 16U, 29U, 40U, 65'536U, 100'000U, 300'000U}) {
    EXPECT_EQ(content(size), bytes.substr(0, bytes.size() / size * size)) << size;
  }
}

TEST_F(RecordFiles, TellWhatIsOdd) {
  write_whole_file(path_, "");
  EXPECT_EQ(RecordFile(path_, 3).records(), 0U);
  EXPECT_EQ(RecordFile(path_, 3).warning(), path_.string() + ": empty file, taken as a scan without points");
  EXPECT_EQ(content(3), "");
  write_whole_file(path_, "abcdef");
  EXPECT_EQ(RecordFile(path_, 3).records(), 2U);
  EXPECT_EQ(RecordFile(path_, 3).warning(), "");
  EXPECT_NE(RecordFile(path_, 4).warning().find("2 bytes after record 1"), std::string::npos);
  EXPECT_EQ(content(4), "abcd");
  EXPECT_EQ(content(7), "") << "less than one record";
}

TEST_F(RecordFiles, NameWhatIsNotData) {
  write_whole_file(path_, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 16\n");
  EXPECT_NE(fault().find(path_.string() + ": is a Git LFS pointer"), std::string::npos) << fault();
  write_whole_file(path_, "PK\x03\x04 and so on");
  EXPECT_NE(fault().find("zip archive"), std::string::npos);
  fs::remove(path_);
  EXPECT_NE(fault().find(path_.string() + ": cannot open: No such file"), std::string::npos) << fault();
  fs::create_directory(path_);
  EXPECT_NE(fault().find(path_.string() + ": cannot open: Is a directory"), std::string::npos) << fault();
}

TEST_F(RecordFiles, SparseFilesBeyondAnyScanAreRefused) {
  write_whole_file(path_, std::string(16, 'x'));
  fs::resize_file(path_, kMaxRecordFileBytes + 1);
  try {
    const RecordFile file(path_, 16);
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find(path_.string() + ": has 1073741825 bytes, expected at most 1073741824"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(RecordFiles, FilesThatAreCutMeanwhileAreErrors) {
  write_whole_file(path_, std::string(200'000, 'x'));
  RecordFile file(path_, 4);
  EXPECT_FALSE(file.next().empty());
  fs::resize_file(path_, 100'000);
  try {
    while (!file.next().empty()) {
    }
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find(path_.string() + ": ends at byte 100000, expected 200000"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
