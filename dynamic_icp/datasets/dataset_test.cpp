// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/datasets/dataset.hpp"

#include <algorithm>
#include <fstream>

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

TEST_F(OpenDataset, ArchivesAndTheLikeAreNamed) {
  const auto fault = [&](const fs::path& input) -> std::string {
    try {
      open_dataset(input);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  };
  std::ofstream(folder_ / "b.tar.gz", std::ios::binary) << std::string("\x1F\x8B\x08\0\0\0\0\0\0\x03", 10);
  EXPECT_EQ(fault(folder_), (folder_ / "b.tar.gz").string() +
                                ": is compressed with gzip; unpack it first ('gunzip', or 'tar xzf' for a .tar.gz)");
  std::ofstream(folder_ / "a.zip", std::ios::binary) << "PK\x03\x04";
  EXPECT_EQ(fault(folder_), (folder_ / "a.zip").string() + ": is a zip archive; unpack it first");
  EXPECT_EQ(fault(folder_ / "a.zip"), fault(folder_));
  std::ofstream(folder_ / "drive.mcap", std::ios::binary) << "\x89MCAP0\r\n";
  EXPECT_EQ(fault(folder_ / "drive.mcap"), (folder_ / "drive.mcap").string() + ": is an MCAP recording");
  std::ofstream(folder_ / "notes.txt") << "nothing";
  EXPECT_NE(fault(folder_ / "notes.txt").find("not a recording of a known layout"), std::string::npos);
}

TEST_F(OpenDataset, AnUnknownFormatNameIsWrongUse) {
  EXPECT_THROW(open_dataset(folder_, {.format = "vhs"}), UsageError);
  const std::vector<std::string> known = known_formats();
  for (const char* format : {"dicp", "hercules", "helipr", "boreas", "aevascenes", "npz", "pcd", "ply", "bin"}) {
    EXPECT_NE(std::find(known.begin(), known.end(), format), known.end()) << format;
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
