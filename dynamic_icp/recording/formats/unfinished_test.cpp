// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/unfinished.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class UnfinishedTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::temp_directory_path() / ("unfinished_test-" + std::to_string(::getpid()));
};

TEST_F(UnfinishedTest, IsRemovedWithAllThatIsInItAndNothingElse) {
  const fs::path deep = folder_ / "a" / "b" / "c";
  fs::create_directories(deep);
  for (int i = 0; i < 2000; ++i) {
    std::ofstream(deep / std::to_string(i)) << i;
  }
  fs::create_directory(folder_ / "kept");
  std::ofstream(folder_ / "kept" / "file") << "";
  fs::create_directory_symlink(folder_ / "kept", deep / "link");
  std::ofstream(folder_ / "single") << "";
  std::ofstream(folder_ / "finished") << "";
  { const Unfinished finished(folder_ / "finished"); }
  const Unfinished folder(folder_ / "a");
  const Unfinished file(folder_ / "single");
  const Unfinished missing(folder_ / "missing");
  remove_unfinished();
  std::vector<std::string> left;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    left.push_back(entry.path().filename().string());
  }
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::string>{"finished", "kept"}));
  EXPECT_TRUE(fs::exists(folder_ / "kept" / "file")) << "a link is not followed";
}

TEST_F(UnfinishedTest, MoreThanCanBeRememberedAreNoFault) {
  std::vector<std::unique_ptr<Unfinished>> many;
  for (int i = 0; i < 100; ++i) {
    many.push_back(std::make_unique<Unfinished>(folder_ / std::to_string(i)));
  }
  many.clear();
  std::ofstream(folder_ / "1") << "";
  const Unfinished one(folder_ / "1");
  remove_unfinished();
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace dynamic_icp::formats
