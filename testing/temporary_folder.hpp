// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace dynamic_icp::benchmark {

/// A test with a folder of its own, removed at the end.
class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string(test->test_suite_name()) + "." + test->name() + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  static void write_file(const std::filesystem::path& path, const std::string& content) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << content;
  }

  /// A recording of so many scans of one point in the plain layout.
  static void make_recording(const std::filesystem::path& path, int scans = 2) {
    for (int i = 1; i <= scans; ++i) {
      write_file(path / "point_clouds" / ("0000" + std::to_string(i) + ".bin"), std::string(16, '\0'));
    }
  }

  std::filesystem::path folder_;
};

}  // namespace dynamic_icp::benchmark
