// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/folder_moves.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/path_lock.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class FolderMovesTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(parent_); }
  void TearDown() override { fs::remove_all(parent_); }

  /// A result of these texts, which say whose it is.
  static void make(const fs::path& folder, const std::string& text) {
    fs::create_directories(folder / "labels");
    std::ofstream(folder / "run.json") << text;
    std::ofstream(folder / "labels" / "1.bin") << text;
  }
  /// The text of a whole result; empty when it is none.
  static std::string text_of(const fs::path& folder) {
    const std::string text = read(folder / "run.json");
    return text == read(folder / "labels" / "1.bin") ? text : "";
  }
  static std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::ptrdiff_t entries(const fs::path& folder) {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }
  static void move(const fs::path& from, const fs::path& to) { fs::rename(from, to); }

  static void anything(const fs::path& /*folder*/) {}
  /// Lets go what lies at the target, and nothing once it was moved away.
  [[nodiscard]] FolderCheck target_only() const {
    return [this](const fs::path& folder) {
      if (folder != out_) {
        throw std::runtime_error("not this");
      }
    };
  }

  fs::path parent_ = fs::temp_directory_path() / ("folder_moves_test-" + std::to_string(::getpid()));
  fs::path out_ = parent_ / "out";
  fs::path staging_ = parent_ / ".out.partial-1";
};

TEST_F(FolderMovesTest, ReplacesAtOnceOrInTwoSteps) {
  make(out_, "earlier");
  make(staging_, "new");
  EXPECT_THROW(move_beside(out_, "1", target_only()), std::runtime_error);
  EXPECT_EQ(text_of(out_), "earlier");
  EXPECT_THROW(replace_in_two_steps(out_, "1", target_only()), std::runtime_error);
  EXPECT_EQ(text_of(out_), "earlier");
  EXPECT_EQ(entries(parent_), 2);
  move_beside(out_, "1", anything);
  EXPECT_EQ(text_of(out_), "new");
  make(staging_, "newer");
  replace_in_two_steps(out_, "1", anything);
  EXPECT_EQ(text_of(out_), "newer");
  EXPECT_EQ(entries(parent_), 1);
}

TEST_F(FolderMovesTest, MovesWithinAFolderThatMustStay) {
  const fs::path partial = out_ / ".dynamic-icp.partial-1";
  fs::create_directory(out_);
  EXPECT_TRUE(is_vacant(out_));
  make(partial, "one");
  EXPECT_TRUE(is_vacant(out_)) << "what is ours does not count";
  move_within(out_, "1", "run.json", anything);
  EXPECT_EQ(text_of(out_), "one");
  make(partial, "two");
  EXPECT_THROW(move_within(out_, "1", "run.json", target_only()), std::runtime_error);
  EXPECT_EQ(text_of(out_), "one");
  EXPECT_THROW(move_within(out_, "2", "run.json", anything), std::system_error) << "there is no such folder";
  EXPECT_EQ(text_of(out_), "one");
  move_within(out_, "1", "run.json", anything);
  EXPECT_EQ(text_of(out_), "two");
  EXPECT_EQ(entries(out_), 2);
}

TEST_F(FolderMovesTest, AnEarlierResultThatWasMovedAwayComesBack) {
  make(parent_ / ".out.replaced-12", "earlier");
  make(staging_, "new");
  remove_leftovers(out_);
  EXPECT_EQ(text_of(out_), "earlier");
  EXPECT_EQ(entries(parent_), 1);
  make(parent_ / ".out.replaced-12", "even earlier");
  remove_leftovers(out_);
  EXPECT_EQ(text_of(out_), "earlier") << "it was replaced";
  EXPECT_EQ(entries(parent_), 1);
}

TEST_F(FolderMovesTest, AResultThatWasArrivingWithinArrives) {
  const fs::path arriving = out_ / ".dynamic-icp.arriving-12";
  make(arriving, "new");
  make(out_ / ".dynamic-icp.replaced-12", "earlier");
  move(arriving / "labels", out_ / "labels");  // killed after the first one
  remove_leftovers(out_);
  EXPECT_EQ(text_of(out_), "new");
  EXPECT_EQ(entries(out_), 2);
}

TEST_F(FolderMovesTest, AResultThatMadeRoomWithinForOneThatIsNotWholeComesBack) {
  const fs::path replaced = out_ / ".dynamic-icp.replaced-12";
  make(out_, "earlier");
  make(out_ / ".dynamic-icp.partial-12", "new");
  fs::create_directory(replaced);
  move(out_ / "run.json", replaced / "run.json");
  remove_leftovers(out_);
  EXPECT_EQ(text_of(out_), "earlier");
  EXPECT_EQ(entries(out_), 2);
  make(replaced, "even earlier");
  remove_leftovers(out_);
  EXPECT_EQ(text_of(out_), "earlier") << "it was replaced";
  EXPECT_EQ(entries(out_), 2);
}

TEST_F(FolderMovesTest, WhatOthersHoldOrIsNotOursStays) {
  make(staging_, "being written");
  make(out_ / ".dynamic-icp.partial-1", "being written");
  make(parent_ / ".out.partial-mine", "not ours");
  make(parent_ / ".other.partial-1", "not of this one");
  {
    const PathLock beside(staging_);
    const PathLock within(out_ / ".dynamic-icp.partial-1");
    ASSERT_TRUE(beside.held() && within.held());
    remove_leftovers(out_);
    EXPECT_EQ(entries(parent_), 4);
    EXPECT_EQ(entries(out_), 1);
  }
  remove_leftovers(out_);
  EXPECT_EQ(entries(parent_), 3);
  EXPECT_TRUE(fs::is_empty(out_));
}

TEST_F(FolderMovesTest, AFolderMayStayWhereItIs) {
  fs::create_directory(out_);
  EXPECT_FALSE(must_stay(out_));
  EXPECT_FALSE(must_stay(parent_ / "missing"));
  EXPECT_TRUE(must_stay("/proc")) << "a mount point";
  EXPECT_TRUE(must_stay(fs::current_path()));
}

}  // namespace
}  // namespace dynamic_icp::formats
