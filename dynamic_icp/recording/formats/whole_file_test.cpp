// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include <csignal>
#include <fstream>
#include <new>
#include <stdexcept>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  /// That it throws DataError, which names the file "a" and holds these words.
  template <class Action>
  void expect_refusal(const Action& action, const std::string& words) const {
    try {
      action();
      ADD_FAILURE() << "must throw: " << words;
    } catch (const DataError& error) {
      EXPECT_EQ(std::string(error.what()).find((folder_ / "a").string()), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  fs::path folder_ = fs::temp_directory_path() / ("whole_file_test-" + std::to_string(::getpid()));
};

TEST_F(WholeFile, WritesAndReadsBack) {
  std::string content(100'000, 'x');
  content += std::string("\0\n", 2);
  write_whole_file(folder_ / "a", content);
  EXPECT_EQ(read_whole_file(folder_ / "a"), content);
  write_whole_file(folder_ / "a", "");
  EXPECT_EQ(read_whole_file(folder_ / "a"), "");
  EXPECT_EQ(entries(), 1u) << "no temporary file may stay";
}

TEST_F(WholeFile, FailureNamesTheFileAndLeavesTheEarlierOne) {
  write_whole_file(folder_ / "a", "earlier");
  fs::create_directory(folder_ / "b");
  std::ofstream(folder_ / "b" / "inside") << "x";
  try {
    write_whole_file(folder_ / "b", "a file where a folder is");
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "b").string()), std::string::npos);
  }
  EXPECT_THROW(write_whole_file(folder_ / "missing" / "a", "x"), DataError);
  EXPECT_EQ(read_whole_file(folder_ / "a"), "earlier");
  EXPECT_EQ(entries(), 2u);
}

TEST_F(WholeFile, NothingStaysOfAFileThatCannotBeOpenedAgain) {
  fs::permissions(folder_, fs::perms::all);
  const uid_t own = ::geteuid();
  constexpr uid_t kNobody = 65534;  // root may write what nobody may
  const bool dropped = own == 0 && ::seteuid(kNobody) == 0;
  const mode_t mask = ::umask(0222);
  expect_refusal([&] { write_whole_file(folder_ / "a", "x"); }, "cannot create");
  ::umask(mask);
  if (dropped) {
    ASSERT_EQ(::seteuid(own), 0);
  }
  EXPECT_EQ(entries(), 0U);
}

TEST_F(WholeFile, WhatAKilledWriterLeftIsWrittenOver) {
  const pid_t child = ::fork();
  if (child == 0) {
    StagedFile file(folder_ / "a");
    file.write("longer than what comes after it");
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(entries(), 1U) << "what it left";
  write_whole_file(folder_ / "b", "x");
  EXPECT_EQ(entries(), 2U) << "that of another file is nobody else's";
  write_whole_file(folder_ / "a", "whole");
  EXPECT_EQ(read_whole_file(folder_ / "a"), "whole");
  EXPECT_EQ(entries(), 2U);
}

TEST_F(WholeFile, AFileGoesOnAfterAGivenLength) {
  {
    OutputFile file(folder_ / "a");
    file.write("0123456789");
    EXPECT_EQ(file.synchronise(), 10U);
  }
  {
    OutputFile file = OutputFile::resume(folder_ / "a", 4);
    file.write("ab");
    EXPECT_EQ(file.synchronise(), 6U);
    file.close();
  }
  EXPECT_EQ(read_whole_file(folder_ / "a"), "0123ab");
  expect_refusal([&] { OutputFile::resume(folder_ / "a", 7); }, "has 6 bytes, expected at least 7");
  EXPECT_EQ(read_whole_file(folder_ / "a"), "0123ab");
  fs::remove(folder_ / "a");
  expect_refusal([&] { OutputFile::resume(folder_ / "a", 0); }, "cannot open");
  EXPECT_EQ(entries(), 0U);
  write_whole_file(folder_ / "other", "of somebody");
  fs::create_symlink(folder_ / "other", folder_ / "a");
  expect_refusal([&] { OutputFile::resume(folder_ / "a", 0); }, "cannot open");
  EXPECT_EQ(read_whole_file(folder_ / "other"), "of somebody");
  fs::remove(folder_ / "a");
  ASSERT_EQ(::mkfifo((folder_ / "a").c_str(), 0600), 0);
  expect_refusal([&] { OutputFile::resume(folder_ / "a", 0); }, "cannot open");
}

TEST_F(WholeFile, TwoWritersDoNotMeet) {
  StagedFile slow(folder_ / "a");
  slow.write("slow");
  write_whole_file(folder_ / "a", "fast");
  EXPECT_EQ(read_whole_file(folder_ / "a"), "fast");
  slow.write("er");
  slow.commit();
  EXPECT_EQ(read_whole_file(folder_ / "a"), "slower");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(WholeFile, ALinkInTheWayIsNotFollowed) {
  write_whole_file(folder_ / "other", "untouched");
  fs::create_symlink(folder_ / "other", folder_ / "a.partial-1");
  write_whole_file(folder_ / "a", "x");
  EXPECT_EQ(read_whole_file(folder_ / "other"), "untouched");
}

TEST_F(WholeFile, ADeviceOrPipeIsWrittenIntoAndStays) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_whole_file(pipe, "into the pipe");
  std::string content(100, '\0');
  const ssize_t got = ::read(reader, content.data(), content.size());
  ::close(reader);
  ASSERT_EQ(got, 13);
  EXPECT_EQ(content.substr(0, 13), "into the pipe");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(entries(), 1u);
}

TEST_F(WholeFile, FullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full on this machine";
  }
  OutputFile file("/dev/full");
  EXPECT_THROW(file.write("x"), DataError);
}

TEST_F(WholeFile, ReadingWhatIsNotThereIsAnError) {
  EXPECT_THROW(read_whole_file(folder_ / "missing"), DataError);
  EXPECT_THROW(read_whole_file(folder_), DataError);
}

TEST_F(WholeFile, IsReadIntoAsMuchMemoryAsItIsLong) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, std::size_t{10'000'000}}) {
    write_whole_file(folder_ / "a", std::string(size, 'x'));
    const std::string content = read_whole_file(folder_ / "a");
    EXPECT_EQ(content, std::string(size, 'x'));
    EXPECT_LE(content.capacity(), size + 4096);
  }
  EXPECT_GT(read_whole_file("/proc/self/status").size(), 100U) << "has no size before it is read";
}

TEST_F(WholeFile, WhatIsTooLongIsRefusedBeforeItIsRead) {
  write_whole_file(folder_ / "a", "12345");
  EXPECT_EQ(read_whole_file(folder_ / "a", 5), "12345");
  expect_refusal([&] { (void)read_whole_file(folder_ / "a", 4); }, "has 5 bytes, expected at most 4");
  fs::resize_file(folder_ / "a", kMaxTextBytes + 1);
  expect_refusal([&] { (void)read_text_file(folder_ / "a"); }, "expected at most");
}

TEST_F(WholeFile, LackOfMemoryNamesTheFile) {
  expect_refusal([&] { with_memory_for(folder_ / "a", [] { throw std::bad_alloc(); }); }, "too little memory");
  expect_refusal([&] { with_memory_for(folder_ / "a", [] { throw std::length_error("vector"); }); },
                 "too little memory");
  EXPECT_EQ(with_memory_for(folder_ / "a", [] { return 7; }), 7);
}

TEST_F(WholeFile, TextsHoldNoZeroBytesAndNothingElse) {
  write_whole_file(folder_ / "a", "{}\n");
  EXPECT_EQ(read_text_file(folder_ / "a"), "{}\n");
  write_whole_file(folder_ / "a", std::string("{}\n\0\0", 5));
  expect_refusal([&] { (void)read_text_file(folder_ / "a"); }, "line 2: has a zero byte, expected text");
  write_whole_file(folder_ / "a", std::string("PK\x03\x04\0", 5));
  expect_refusal([&] { (void)read_text_file(folder_ / "a"); }, "is a zip archive");
}

TEST_F(WholeFile, LinesAreReadOfFilesOfAnyLength) {
  const std::string long_line(2'500'000, 'x');  // over the ends of blocks
  const std::vector<std::string> lines = {"a", "", long_line, "b", std::string((1U << 20U) - 1, 'y'), long_line};
  for (const bool has_end : {true, false}) {
    std::string text;
    for (const std::string& line : lines) {
      text += (text.empty() ? "" : "\n") + line;
    }
    write_whole_file(folder_ / "a", text + (has_end ? "\n" : ""));
    std::vector<std::string> read;
    for_each_text_line(folder_ / "a", [&](std::string_view line, std::size_t number) {
      read.emplace_back(line);
      EXPECT_EQ(number, read.size());
    });
    EXPECT_TRUE(read == lines);
  }
  write_whole_file(folder_ / "a", "");
  for_each_text_line(folder_ / "a", [](std::string_view, std::size_t) { ADD_FAILURE() << "there is none"; });
  const auto read = [&] { for_each_text_line(folder_ / "a", [](std::string_view, std::size_t) {}); };
  write_whole_file(folder_ / "a", std::string("{}\n\0\0", 5));
  expect_refusal(read, "line 2: has a zero byte, expected text");
  write_whole_file(folder_ / "a", std::string("PK\x03\x04\0", 5));
  expect_refusal(read, "is a zip archive");
  fs::remove(folder_ / "a");
  expect_refusal(read, "cannot open");
  fs::create_directory(folder_ / "a");
  EXPECT_THROW(read(), DataError);
}

}  // namespace
}  // namespace dynamic_icp::formats
