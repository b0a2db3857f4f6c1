// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/numbered_files.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class NumberedFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  void make(const std::string& name) { std::ofstream(folder_ / name) << "x"; }
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const fs::path& path : numbered_files(folder_, ".bin")) {
      result.push_back(path.filename().string());
    }
    return result;
  }
  fs::path folder_ = fs::temp_directory_path() / ("numbered_files_test-" + std::to_string(::getpid()));
};

TEST_F(NumberedFiles, OrdersByNumberNotByText) {
  for (const char* name : {"10.bin", "9.bin", "frame_002.bin", "00001.bin", "1724479779384729506123456789.bin"}) {
    make(name);
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"00001.bin", "frame_002.bin", "9.bin", "10.bin",
                                               "1724479779384729506123456789.bin"}));
}

TEST_F(NumberedFiles, LeavesOutOtherFiles) {
  for (const char* name : {"1.bin", "1.txt", "._2.bin", "notes.bin", "3.bin.partial"}) {
    make(name);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"1.bin"});
}

TEST_F(NumberedFiles, TheSameNumberTwiceIsAnError) {
  make("1.bin");
  make("01.bin");
  EXPECT_THROW(names(), DataError);
}

// By the last run of digits alone they would come as 0, 1, 2.
TEST_F(NumberedFiles, SecondsGoBeforeTheirFractions) {
  for (const char* name : {"1700000001.000000000.bin", "1700000000.100000000.bin", "1700000000.900000000.bin"}) {
    make(name);
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"1700000000.100000000.bin", "1700000000.900000000.bin",
                                               "1700000001.000000000.bin"}));
}

TEST_F(NumberedFiles, AMissingFolderIsAnError) { EXPECT_THROW(numbered_files(folder_ / "no", ".bin"), DataError); }

}  // namespace
}  // namespace dynamic_icp::datasets
