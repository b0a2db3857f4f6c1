// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/result_kind.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

TEST(ResultKind, PatternsStandForNumbersOnly) {
  for (const char* name : {"labels/1.bin", "labels/00001.bin", "labels/7.bin.partial-12"}) {
    EXPECT_TRUE(matches(name, "labels/#.bin")) << name;
  }
  for (const char* name : {"labels/.bin", "labels/1a.bin", "labels/1.bin~", "labels/1.bin.partial-", "labels/1.bi",
                           "1.bin", "Labels/1.bin", "labels/1/1.bin", ""}) {
    EXPECT_FALSE(matches(name, "labels/#.bin")) << name;
  }
  EXPECT_TRUE(matches("a_12_34.npz", "a_#_#.npz"));
  EXPECT_FALSE(matches("a_12_.npz", "a_#_#.npz"));
}

TEST(ResultKind, FindsWhatIsNoPart) {
  const fs::path folder = fs::temp_directory_path() / ("result_kind_test-" + std::to_string(::getpid()));
  const ResultKind kind = {"a.json", [](const fs::path&) {
                             return std::vector<std::string>{"a.json", "x/y/#.bin", "x/z.txt"};
                           }};
  fs::create_directories(folder / "x" / "y");
  fs::create_directories(folder / ".dynamic-icp.partial-12" / "anything");
  for (const char* name : {"a.json", "x/y/1.bin", "x/z.txt"}) {
    std::ofstream(folder / name) << "";
  }
  EXPECT_EQ(foreign_entry(folder, kind), std::nullopt);
  for (const char* name : {"b.json", "x/a.json", "x/y/z.txt"}) {
    std::ofstream(folder / name) << "";
    EXPECT_EQ(foreign_entry(folder, kind), folder / name);
    fs::remove(folder / name);
  }
  for (const char* name : {"y", "x/z", "x/y/1.bin.d", "x/y/2.bin"}) {
    fs::create_directory(folder / name);
    EXPECT_EQ(foreign_entry(folder, kind), folder / name) << "a folder for none of the files";
    fs::remove(folder / name);
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dynamic_icp::formats
