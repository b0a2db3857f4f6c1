// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/output_folder.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

const ResultKind kRun = {"run.json", [](const fs::path&) {
                           return std::vector<std::string>{"run.json", "labels/#.bin"};
                         }};

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(parent_); }
  void TearDown() override {
    fs::current_path(started_);
    fs::remove_all(parent_);
  }

  static void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(parent_), fs::directory_iterator()));
  }

  /// Writes a result of one file into the place.
  static void put(const fs::path& place, const std::string& text, bool replace = false) {
    OutputFolder folder(place, kRun, replace);
    write(folder.path() / "run.json", text);
    folder.commit();
  }

  /// The message of what is thrown.
  template <class Error, class Call>
  static std::string message(const Call& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing of the kind was thrown";
    return {};
  }

  fs::path started_ = fs::current_path();
  fs::path parent_ = fs::temp_directory_path() / ("output_folder_test-" + std::to_string(::getpid()));
  fs::path out_ = parent_ / "out";
};

TEST_F(OutputFolderTest, AppearsAtCommitOnly) {
  {
    OutputFolder folder(out_, kRun, false);
    write(folder.path() / "run.json", "{}");
    EXPECT_FALSE(fs::exists(out_));
    folder.commit();
  }
  EXPECT_EQ(read(out_ / "run.json"), "{}");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFolderTest, WithoutCommitNothingStays) {
  {
    OutputFolder folder(out_, kRun, false);
    write(folder.path() / "run.json", "{}");
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(OutputFolderTest, AnEarlierResultIsKeptUnlessReplacedOnPurpose) {
  fs::create_directory(out_);
  write(out_ / "run.json", "earlier");
  EXPECT_THROW(OutputFolder(out_, kRun, false), DataError);
  {
    OutputFolder folder(out_, kRun, true);  // fails on the way: no commit
  }
  EXPECT_EQ(read(out_ / "run.json"), "earlier");
  {
    OutputFolder folder(out_, kRun, true);
    write(folder.path() / "run.json", "new");
    folder.commit();
  }
  EXPECT_EQ(read(out_ / "run.json"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFolderTest, ForeignFoldersAreNeverReplaced) {
  fs::create_directory(out_);
  write(out_ / "thesis.tex", "years of work");
  EXPECT_THROW(OutputFolder(out_, kRun, true), DataError);
  EXPECT_EQ(read(out_ / "thesis.tex"), "years of work");
  write(parent_ / "file", "");
  EXPECT_THROW(OutputFolder(parent_ / "file", kRun, true), DataError);
}

TEST_F(OutputFolderTest, AnEmptyFolderAndATrailingSlashAreFine) {
  fs::create_directory(out_);
  OutputFolder folder(out_.string() + "/", kRun, false);
  write(folder.path() / "run.json", "{}");
  folder.commit();
  EXPECT_EQ(read(out_ / "run.json"), "{}");
}

/// Starts a result there in a process that is killed then; `name` is a file in it.
void leave_behind(const fs::path& place, const char* name) {
  const pid_t child = ::fork();
  if (child == 0) {
    const OutputFolder killed(place, kRun, false);
    std::ofstream(killed.path() / name) << "half";
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
}

TEST_F(OutputFolderTest, RemovesWhatAKilledProcessLeftButNotWhatOneStillWrites) {
  leave_behind(out_, "run.json");
  EXPECT_EQ(entries(), 1u) << "the staging folder of the killed process";
  const OutputFolder running(parent_ / "other", kRun, false);
  {
    OutputFolder folder(out_, kRun, false);
    EXPECT_EQ(entries(), 2u) << "this one's and the other's";
    EXPECT_TRUE(fs::exists(folder.path()));
  }
  EXPECT_TRUE(fs::exists(running.path()));
}

TEST_F(OutputFolderTest, RemovesWhatKilledProcessesLeftOfOtherResultsBesideIt) {
  leave_behind(parent_ / "first", "run.json");
  leave_behind(parent_ / "second", "frames.txt");  // no file of such a result
  fs::create_directories(parent_ / ".partial-7");  // of no name
  fs::create_directories(parent_ / ".x.partial-7a");
  write(parent_ / ".y.partial-7", "a file");
  const OutputFolder running(parent_ / "running", kRun, false);
  EXPECT_EQ(entries(), 5u) << "that of `first` is gone already";
  put(out_, "new");
  EXPECT_TRUE(fs::exists(running.path()));
  EXPECT_EQ(entries(), 6u) << "second, the three of the user, running, out";
}

/// A kind whose partial results can be gone on with.
ResultKind with_checkpoint() {
  ResultKind kind = kRun;
  kind.files = [](const fs::path&) { return std::vector<std::string>{"run.json", "checkpoint"}; };
  kind.checkpoint = "checkpoint";
  return kind;
}

using Leftover = OutputFolder::Leftover;

TEST_F(OutputFolderTest, APartialResultWithACheckpointIsTakenOver) {
  const fs::path place = parent_ / "place";
  const ResultKind kind = with_checkpoint();
  for (const bool is_written : {false, true}) {
    {
      OutputFolder first(place, kind, false);
      EXPECT_FALSE(first.had_checkpoint());
      if (is_written) {
        write(first.path() / "checkpoint", "half");
        first.keep();
      }
    }
    EXPECT_EQ(entries(), is_written ? 1U : 0U) << "what is not to be kept is removed";
  }
  {
    OutputFolder second(place, kind, false, {}, Leftover::kTakeOver);
    EXPECT_TRUE(second.had_checkpoint());
    EXPECT_EQ(read(second.path() / "checkpoint"), "half");
    EXPECT_EQ(message<DataError>([&] { OutputFolder(place, kind, false, {}, Leftover::kTakeOver); }),
              place.string() + ": another process is writing this result");
  }
  EXPECT_EQ(entries(), 1U) << "and stays for the next one";
  OutputFolder(parent_ / "other", kind, false);
  EXPECT_EQ(entries(), 1U) << "whatever others write beside it";
  OutputFolder third(place, kind, false, {}, Leftover::kTakeOver);
  fs::remove(third.path() / "checkpoint");
  write(third.path() / "run.json", "whole");
  third.commit();
  EXPECT_EQ(read(place / "run.json"), "whole");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFolderTest, APartialResultWithACheckpointMakesRoomForANewOne) {
  const fs::path place = parent_ / "place";
  const ResultKind kind = with_checkpoint();
  {
    OutputFolder first(place, kind, false);
    write(first.path() / "checkpoint", "half");
    first.keep();
  }
  OutputFolder second(place, kind, false);
  EXPECT_TRUE(second.had_checkpoint());
  EXPECT_TRUE(fs::is_empty(second.path()));
  EXPECT_EQ(entries(), 1U);
  second.keep();
  second.drop();
}

TEST_F(OutputFolderTest, APartialResultWithinAFolderThatStaysIsTakenOverToo) {
  const fs::path place = parent_ / "place";
  fs::create_directories(place);
  fs::current_path(place);
  const ResultKind kind = with_checkpoint();
  {
    OutputFolder first(place, kind, false);
    write(first.path() / "checkpoint", "half");
    first.keep();
  }
  OutputFolder second(place, kind, false, {}, Leftover::kTakeOver);
  EXPECT_TRUE(second.had_checkpoint());
  EXPECT_EQ(read(second.path() / "checkpoint"), "half");
  fs::remove(second.path() / "checkpoint");
  write(second.path() / "run.json", "whole");
  second.commit();
  EXPECT_EQ(read(place / "run.json"), "whole");
}

TEST_F(OutputFolderTest, AFolderThatCannotBeCreatedIsAnError) {
  write(parent_ / "file", "");
  EXPECT_THROW(OutputFolder(parent_ / "file" / "out", kRun, false), DataError);
}

TEST_F(OutputFolderTest, WhatIsNoPartOfAResultIsNeverReplaced) {
  for (const char* name : {"notes.txt", "labels/mine.bin", "labels/1.bin/x", "data/a", "run.json.txt", ".hidden"}) {
    put(out_, "earlier");
    fs::create_directories((out_ / name).parent_path());
    write(out_ / name, "years of work");
    const std::string said = message<DataError>([&] { const OutputFolder folder(out_, kRun, true); });
    EXPECT_NE(said.find(*fs::path(name).begin()), std::string::npos) << said;
    EXPECT_EQ(read(out_ / name), "years of work");
    fs::remove_all(out_);
  }
  put(out_, "earlier");
  fs::create_directory(out_ / "empty");
  EXPECT_THROW(OutputFolder(out_, kRun, true), DataError);
  fs::remove(out_ / "empty");
  fs::create_directory_symlink(parent_, out_ / "labels");
  EXPECT_THROW(OutputFolder(out_, kRun, true), DataError) << "a link is not what was written";
}

TEST_F(OutputFolderTest, WhatComesWhileItIsWrittenIsNotRemoved) {
  put(out_, "earlier");
  {
    OutputFolder folder(out_, kRun, true);
    write(folder.path() / "run.json", "new");
    write(out_ / "notes.txt", "years of work");
    EXPECT_THROW(folder.commit(), DataError);
  }
  EXPECT_EQ(read(out_ / "notes.txt"), "years of work");
  EXPECT_EQ(read(out_ / "run.json"), "earlier");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFolderTest, WhatIsReadIsNotReplaced) {
  put(out_, "earlier");
  fs::create_directory(out_ / "labels");
  write(out_ / "labels" / "00001.bin", "input");
  fs::create_symlink(out_ / "labels" / "00001.bin", parent_ / "link.bin");
  for (const fs::path& input :
       {out_, out_ / "labels" / "00001.bin", parent_ / "." / "out" / "", parent_ / "link.bin"}) {
    const std::string said = message<UsageError>([&] { const OutputFolder folder(out_, kRun, true, {input}); });
    EXPECT_NE(said.find(input.string()), std::string::npos) << said;
  }
  const OutputFolder beside(out_, kRun, true, {parent_, parent_ / "out2", ""});
  EXPECT_EQ(read(out_ / "labels" / "00001.bin"), "input");
}

TEST_F(OutputFolderTest, FollowsALinkToAFolder) {
  fs::create_directories(parent_ / "target");
  fs::create_directory_symlink("target", out_);
  put(out_, "one");
  EXPECT_TRUE(fs::is_symlink(out_));
  EXPECT_EQ(read(parent_ / "target" / "run.json"), "one");
  put(out_, "two", true);
  EXPECT_EQ(read(out_ / "run.json"), "two");
  EXPECT_EQ(entries(), 2u) << "the folder and its link";
  fs::create_directory_symlink("nowhere", parent_ / "dangling");
  const std::string said = message<DataError>([&] { const OutputFolder folder(parent_ / "dangling", kRun, false); });
  EXPECT_NE(said.find("nowhere"), std::string::npos) << said;
}

TEST_F(OutputFolderTest, TheWorkingDirectoryStaysTheSameFolder) {
  fs::create_directory(out_);
  fs::current_path(out_);
  for (const char* text : {"one", "two"}) {
    OutputFolder folder(".", kRun, true);
    write(folder.path() / "run.json", text);
    fs::create_directory(folder.path() / "labels");
    write(folder.path() / "labels" / "1.bin", text);
    EXPECT_FALSE(fs::exists("labels/1.bin") && read("labels/1.bin") == text) << "not before commit";
    folder.commit();
    EXPECT_EQ(read(fs::current_path() / "run.json"), text);
    EXPECT_EQ(read("labels/1.bin"), text);
    EXPECT_TRUE(fs::equivalent(".", out_));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator("."), fs::directory_iterator()), 2);
  { const OutputFolder given_up(".", kRun, true); }
  EXPECT_EQ(read("run.json"), "two");
  write("notes.txt", "years of work");
  EXPECT_THROW(OutputFolder(".", kRun, true), DataError);
  fs::remove("notes.txt");
  fs::current_path("labels");
  EXPECT_THROW(OutputFolder("..", kRun, true), UsageError) << "it would be gone";
}

TEST_F(OutputFolderTest, AMountPointIsFilled) {
  fs::create_directory(out_);
  const std::string quoted = "'" + out_.string() + "'";
  if (std::system(("mount -t tmpfs -o size=64k tmpfs " + quoted + " 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "needs the right to mount a small file system";
  }
  std::string texts;
  try {
    put(out_, "one");
    texts += read(out_ / "run.json");
    put(out_, "two", true);
    texts += read(out_ / "run.json");
  } catch (const DataError& error) {
    ADD_FAILURE() << error.what();
  }
  EXPECT_THROW(OutputFolder(out_, kRun, false), DataError);
  const auto left = std::distance(fs::directory_iterator(out_), fs::directory_iterator());
  EXPECT_EQ(std::system(("umount " + quoted).c_str()), 0);
  EXPECT_EQ(texts, "onetwo");
  EXPECT_EQ(left, 1);
}

TEST_F(OutputFolderTest, OfSeveralWritersAtOnceOneWholeResultIsLeft) {
  for (const bool within : {false, true}) {
    fs::create_directories(out_);
    for (int round = 0; round < 10; ++round) {
      std::vector<pid_t> children;
      for (const char* text : {"a", "b", "c"}) {
        children.push_back(::fork());
        if (children.back() == 0) {
          if (within) {
            fs::current_path(out_);
          }
          int status = 0;
          try {
            OutputFolder folder(out_, kRun, true);
            for (const char* name : {"1.bin", "2.bin", "3.bin"}) {
              fs::create_directories(folder.path() / "labels");
              write(folder.path() / "labels" / name, text);
            }
            write(folder.path() / "run.json", text);
            folder.commit();
          } catch (const DataError& error) {
            std::fprintf(stderr, "%s\n", error.what());
            status = 1;
          }
          ::_exit(status);
        }
      }
      for (const pid_t child : children) {
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
      }
      const std::string text = read(out_ / "run.json");
      EXPECT_EQ(text.size(), 1u);
      for (const char* name : {"1.bin", "2.bin", "3.bin"}) {
        EXPECT_EQ(read(out_ / "labels" / name), text);
      }
      EXPECT_EQ(entries(), 1u);
      EXPECT_EQ(std::distance(fs::directory_iterator(out_), fs::directory_iterator()), 2);
    }
    fs::remove_all(out_);
  }
}

TEST_F(OutputFolderTest, MessagesNameTheFinalPlace) {
  const OutputFolder folder(out_ / "", kRun, false);
  const std::string file = (folder.path() / "labels" / "1.bin").string();
  const std::string shown = (out_ / "labels" / "1.bin").string();
  EXPECT_EQ(folder.in_final_names(file + ": full, " + file), shown + ": full, " + shown);
  EXPECT_EQ(message<DataError>([&] { folder.fill([&] { throw DataError(file + ": full"); }); }), shown + ": full");
}

}  // namespace
}  // namespace dynamic_icp::formats
