// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/folder_entries.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

class FolderEntriesTest : public benchmark::FolderTest {};

TEST_F(FolderEntriesTest, AreWhatLiesInTheFolderItself) {
  write_file(folder_ / "a", "");
  write_file(folder_ / ".b", "");
  write_file(folder_ / "c" / "d", "");
  std::set<fs::path> found;
  for (const fs::directory_entry& entry : entries_in(folder_)) {
    found.insert(entry.path());
  }
  EXPECT_EQ(found, (std::set<fs::path>{folder_ / "a", folder_ / ".b", folder_ / "c"}));
}

TEST_F(FolderEntriesTest, AFolderThatCannotBeReadIsNamed) {
  for (const char* name : {"missing", "file"}) {
    write_file(folder_ / "file", "");
    try {
      entries_in(folder_ / name);
      FAIL() << name << ": no error";
    } catch (const DataError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with((folder_ / name).string() + ": ")) << error.what();
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
