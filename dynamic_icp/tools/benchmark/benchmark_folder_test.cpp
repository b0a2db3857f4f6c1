// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"

#include "dynamic_icp/method/base/error.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

using BenchmarkFolderTest = FolderTest;

TEST_F(BenchmarkFolderTest, IsTakenByOneAtATime) {
  const fs::path path = folder_ / "deep" / "bench";
  {
    const BenchmarkFolder first(path);
    try {
      const BenchmarkFolder second(path);
      ADD_FAILURE() << "two at the same time";
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(path.string() + ": another benchmark is running"), std::string::npos)
          << error.what();
    }
  }
  EXPECT_NO_THROW(BenchmarkFolder{path}) << "free again";
}

TEST_F(BenchmarkFolderTest, IsSharedByThoseWhoRunOneCellEach) {
  const auto shared = FolderLock::Kind::kWithOthers;
  {
    const BenchmarkFolder first(folder_, shared);
    write_file(folder_ / "results.json.partial-123", "{");
    EXPECT_NO_THROW((BenchmarkFolder{folder_, shared}));
    EXPECT_TRUE(fs::exists(folder_ / "results.json.partial-123")) << "another one may be writing it";
    EXPECT_THROW(BenchmarkFolder{folder_}, DataError) << "all of it while cells are running";
  }
  const BenchmarkFolder whole(folder_);
  EXPECT_THROW((BenchmarkFolder{folder_, shared}), DataError);
}

TEST_F(BenchmarkFolderTest, IsNeverSomebodyElses) {
  EXPECT_NO_THROW(BenchmarkFolder{folder_}) << "an empty folder";
  write_file(folder_ / "other" / "thesis.txt", "years of work");
  EXPECT_THROW(BenchmarkFolder{folder_ / "other"}, DataError);
  EXPECT_THROW(BenchmarkFolder{folder_ / "other" / "thesis.txt"}, DataError);
}

TEST_F(BenchmarkFolderTest, LosesFilesThatWereLeftHalfWritten) {
  const fs::path path = folder_ / "bench";
  { const BenchmarkFolder folder(path); }
  write_file(path / "results.json.partial-123", "{");
  write_file(path / "results.json", "{}");
  const BenchmarkFolder folder(path);
  EXPECT_FALSE(fs::exists(path / "results.json.partial-123"));
  EXPECT_TRUE(fs::exists(path / "results.json"));
}

TEST_F(BenchmarkFolderTest, NamesOfFoldersOfRuns) {
  for (const char* name : {"street", "Straße 1", "-", "tables_2", "01.day"}) {
    EXPECT_EQ(unfit_name(name), "") << name;
  }
  for (const char* name : {"", ".", "..", "a/b", "a\\b", "tables", "benchmark.lock", "a\tb", "\x7f", "\xc2\x9b"}) {
    EXPECT_NE(unfit_name(name), "") << name;
  }
  EXPECT_EQ(without_control_characters("a\n\x1b[1m \xc2\x9bß"), "a__[1m _ß");
}

}  // namespace
}  // namespace dynamic_icp::benchmark
