// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/folder_search.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class FolderSearch : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path make(const std::string& name) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "x";
    return folder_ / name;
  }
  static bool is_wanted(const fs::path& folder) { return same_name(folder, "wanted"); }
  fs::path folder_ = fs::temp_directory_path() / ("folder_search_test-" + std::to_string(::getpid()));
};

TEST_F(FolderSearch, NamesAreTheSameInUpperAndLowerCase) {
  EXPECT_TRUE(same_name("a/LiDAR", "lidar"));
  EXPECT_FALSE(same_name("a/LiDARs", "lidar"));
  make("Lidar/AEVA/1.bin");
  EXPECT_EQ(child(folder_, "LiDAR/Aeva"), folder_ / "Lidar" / "AEVA");
  EXPECT_EQ(child(folder_, "LiDAR/Avia"), fs::path());
  EXPECT_EQ(child(folder_ / "no", "LiDAR"), fs::path());
  make("LiDAR/Aeva/1.bin");
  EXPECT_EQ(child(folder_, "LiDAR"), folder_ / "LiDAR") << "spelled so";
}

TEST_F(FolderSearch, FilesAreSeenByTheirExtension) {
  EXPECT_FALSE(holds_files(folder_, ".bin"));
  make("._1.bin");
  EXPECT_FALSE(holds_files(folder_, ".bin")) << "hidden";
  make("1.bin");
  EXPECT_TRUE(holds_files(folder_, ".bin"));
  EXPECT_FALSE(holds_files(folder_, ".npz"));
  EXPECT_FALSE(holds_files(folder_ / "no", ".bin"));
}

TEST_F(FolderSearch, AFolderThatFailsIsNoEmptyOne) {
  const fs::path failing = folder_ / std::string(1000, 'a');  // longer than names can be
  EXPECT_THROW(holds_files(failing, ".bin"), DataError);
  EXPECT_THROW(entries_of(failing, is_visible_folder), DataError);
  EXPECT_TRUE(entries_of(make("1.bin"), is_visible_folder).empty()) << "a file has no entries";
}

TEST_F(FolderSearch, GoesThreeLevelsDown) {
  make("1/2/3/4/wanted/x");
  EXPECT_EQ(find_folder(folder_, is_wanted), fs::path());
  make("1/2/wanted/wanted/x");
  EXPECT_EQ(find_folder(folder_, is_wanted), folder_ / "1/2/wanted");
  EXPECT_EQ(find_folder(folder_ / "1/2/wanted", is_wanted), folder_ / "1/2/wanted") << "the folder itself";
}

TEST_F(FolderSearch, SeveralMustBeNamed) {
  make("b/wanted/x");
  make("a/wanted/x");
  try {
    find_folder(folder_, is_wanted);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()), folder_.string() + ": holds several recordings, name one of them:\n  " +
                                             (folder_ / "a/wanted").string() + "\n  " +
                                             (folder_ / "b/wanted").string());
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
