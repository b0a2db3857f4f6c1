// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/whole_file.hpp"

#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/base/error.hpp"

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

}  // namespace
}  // namespace dynamic_icp::formats
