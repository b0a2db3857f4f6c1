// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/binary_file.hpp"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class BinaryFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// The message of the DataError that `action` throws.
  template <class Action>
  static std::string fault(const Action& action) {
    try {
      action();
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_ = fs::temp_directory_path() / ("binary_file_test-" + std::to_string(::getpid()));
};

TEST_F(BinaryFile, NumbersLieOneAfterTheOther) {
  const std::array<std::int32_t, 2> values = {1, -2};
  write_values<std::int32_t>(folder_ / "a", values);
  EXPECT_EQ(read_whole_file(folder_ / "a"), std::string("\x01\x00\x00\x00\xfe\xff\xff\xff", 8));
  write_values<double>(folder_ / "a", {});
  EXPECT_EQ(read_whole_file(folder_ / "a"), "");
}

TEST_F(BinaryFile, ValuesNeedNoAlignment) {
  std::string bytes;
  append_value<std::uint8_t>(bytes, 7);
  append_value(bytes, -3.25F);
  append_value<std::int16_t>(bytes, -2);
  EXPECT_EQ(bytes, std::string("\x07\x00\x00\x50\xc0\xfe\xff", 7));
  EXPECT_EQ(value_at<float>(bytes, 1), -3.25F);
  EXPECT_EQ(value_at<std::int16_t>(bytes, 5), -2);
}

TEST_F(BinaryFile, FailuresNameFileAndReason) {
  const auto write = [](const fs::path& path) { write_values<double>(path, std::array<double, 1>{1.0}); };
  const std::string missing = fault([&] { write(folder_ / "missing" / "a"); });
  EXPECT_NE(missing.find((folder_ / "missing" / "a").string() + ": cannot create: No such file"), std::string::npos)
      << missing;
  write(folder_ / "file");
  const std::string folder = fault([&] { make_folder(folder_ / "file" / "b"); });
  EXPECT_NE(folder.find((folder_ / "file" / "b").string() + ": cannot create"), std::string::npos) << folder;
  if (fs::exists("/dev/full")) {
    const std::string full = fault([&] { write("/dev/full"); });
    EXPECT_NE(full.find("/dev/full: cannot write: No space left"), std::string::npos) << full;
  }
}

TEST_F(BinaryFile, FoldersAreMadeWithThoseAboveAndMayExist) {
  make_folder(folder_ / "a" / "b");
  make_folder(folder_ / "a" / "b");
  EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b"));
}

}  // namespace
}  // namespace dynamic_icp::formats
