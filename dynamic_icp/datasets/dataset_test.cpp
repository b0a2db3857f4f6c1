// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/datasets/dataset.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class OpenDataset : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_ = fs::temp_directory_path() / ("dataset_test-" + std::to_string(::getpid()));
};

TEST_F(OpenDataset, AMissingInputIsNamed) {
  try {
    open_dataset(folder_ / "no");
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "no").string()), std::string::npos);
  }
}

TEST_F(OpenDataset, AnUnknownLayoutSaysWhatWasLookedFor) {
  try {
    open_dataset(folder_);
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("point_clouds/*.bin"), std::string::npos);
  }
  EXPECT_THROW(open_dataset(folder_, {.format = "dicp"}), DataError);
}

TEST_F(OpenDataset, AnUnknownFormatNameIsWrongUse) {
  EXPECT_THROW(open_dataset(folder_, {.format = "vhs"}), UsageError);
  EXPECT_EQ(known_formats(), (std::vector<std::string>{"dicp", "aevascenes", "npz", "pcd", "ply"}));
}

}  // namespace
}  // namespace dynamic_icp::datasets
