// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/own_files.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class OwnFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(run_ / "labels");
    std::ofstream(run_ / "labels" / "0.bin") << "0";
    std::ofstream(folder_ / "other") << "of somebody";
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string refusal() const {
    try {
      refuse_foreign_files(run_, folder_);
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_ = fs::temp_directory_path() / ("own_files_test-" + std::to_string(::getpid()));
  fs::path run_ = folder_ / "run";
  fs::path inner_ = run_ / "labels" / "1.bin";
};

TEST_F(OwnFiles, FilesAndFoldersOfOnesOwnPass) {
  EXPECT_EQ(refusal(), "");
  EXPECT_NO_THROW(refuse_foreign_files(folder_ / "other", folder_));
  EXPECT_THROW(refuse_foreign_files(folder_ / "nothing", folder_), DataError);
}

TEST_F(OwnFiles, LinksAndPipesAreRefusedByName) {
  fs::create_symlink(folder_ / "other", inner_);
  EXPECT_NE(refusal().find("1.bin: is a link"), std::string::npos) << refusal();
  fs::remove(inner_);
  ASSERT_EQ(::mkfifo(inner_.c_str(), 0600), 0);
  EXPECT_NE(refusal().find("1.bin: is a pipe"), std::string::npos) << refusal();
  fs::remove(inner_);
  fs::create_directory_symlink(run_, folder_ / "way");
  EXPECT_THROW(refuse_foreign_files(folder_ / "way", folder_), DataError) << "of the folder itself";
}

TEST_F(OwnFiles, ThoseOfAnotherUserAreRefusedByName) {
  std::ofstream(inner_) << "1";
  if (::chown(inner_.c_str(), ::geteuid() + 1, static_cast<gid_t>(-1)) != 0) {
    GTEST_SKIP() << "may not give files away";
  }
  EXPECT_NE(refusal().find("1.bin: belongs to another user"), std::string::npos) << refusal();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2) << "nothing is left";
}

}  // namespace
}  // namespace dynamic_icp::formats
