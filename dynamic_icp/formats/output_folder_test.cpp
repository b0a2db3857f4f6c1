// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/output_folder.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(parent_); }
  void TearDown() override { fs::remove_all(parent_); }

  static void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(parent_), fs::directory_iterator()));
  }

  fs::path parent_ = fs::temp_directory_path() / ("output_folder_test-" + std::to_string(::getpid()));
  fs::path out_ = parent_ / "out";
};

TEST_F(OutputFolderTest, AppearsAtCommitOnly) {
  {
    OutputFolder folder(out_, "run.json", false);
    write(folder.path() / "run.json", "{}");
    EXPECT_FALSE(fs::exists(out_));
    folder.commit();
  }
  EXPECT_EQ(read(out_ / "run.json"), "{}");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFolderTest, WithoutCommitNothingStays) {
  {
    OutputFolder folder(out_, "run.json", false);
    write(folder.path() / "run.json", "{}");
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(OutputFolderTest, AnEarlierResultIsKeptUnlessReplacedOnPurpose) {
  fs::create_directory(out_);
  write(out_ / "run.json", "earlier");
  EXPECT_THROW(OutputFolder(out_, "run.json", false), DataError);
  {
    OutputFolder folder(out_, "run.json", true);  // fails on the way: no commit
  }
  EXPECT_EQ(read(out_ / "run.json"), "earlier");
  {
    OutputFolder folder(out_, "run.json", true);
    write(folder.path() / "run.json", "new");
    folder.commit();
  }
  EXPECT_EQ(read(out_ / "run.json"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFolderTest, ForeignFoldersAreNeverReplaced) {
  fs::create_directory(out_);
  write(out_ / "thesis.tex", "years of work");
  EXPECT_THROW(OutputFolder(out_, "run.json", true), DataError);
  EXPECT_EQ(read(out_ / "thesis.tex"), "years of work");
  write(parent_ / "file", "");
  EXPECT_THROW(OutputFolder(parent_ / "file", "run.json", true), DataError);
}

TEST_F(OutputFolderTest, AnEmptyFolderAndATrailingSlashAreFine) {
  fs::create_directory(out_);
  OutputFolder folder(out_.string() + "/", "run.json", false);
  write(folder.path() / "run.json", "{}");
  folder.commit();
  EXPECT_EQ(read(out_ / "run.json"), "{}");
}

TEST_F(OutputFolderTest, RemovesWhatAKilledProcessLeftButNotWhatOneStillWrites) {
  const pid_t child = ::fork();
  if (child == 0) {
    const OutputFolder killed(out_, "run.json", false);
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(entries(), 1u) << "the staging folder of the killed process";
  const OutputFolder running(parent_ / "other", "run.json", false);
  {
    OutputFolder folder(out_, "run.json", false);
    EXPECT_EQ(entries(), 2u) << "this one's and the other's";
    EXPECT_TRUE(fs::exists(folder.path()));
  }
  EXPECT_TRUE(fs::exists(running.path()));
}

TEST_F(OutputFolderTest, AFolderThatCannotBeCreatedIsAnError) {
  write(parent_ / "file", "");
  EXPECT_THROW(OutputFolder(parent_ / "file" / "out", "run.json", false), DataError);
}

}  // namespace
}  // namespace dynamic_icp::formats
