// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/manifest.hpp"

#include "dynamic_icp/method/base/error.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

class ManifestTest : public FolderTest {
 protected:
  Manifest manifest(const std::string& text) const {
    write_file(folder_ / "list.yaml", text);
    return read_manifest(folder_ / "list.yaml");
  }

  template <class Error>
  std::string refusal(const std::string& text) const {
    try {
      manifest(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  }
};

const std::string kList =
    "description: two places\n"
    "format: dicp\n"
    "sequences:\n"
    "  - {name: bridge, folders: [bridge/01_day, Bridge_01_Day]}\n"
    "  - {name: library, folders: [library/01_day]}\n";

TEST_F(ManifestTest, IsReadInItsOrder) {
  const Manifest read = manifest("lidars: [wide, narrow]\n" + kList);
  EXPECT_EQ(read.description, "two places");
  EXPECT_EQ(read.format, "dicp");
  EXPECT_EQ(read.lidars, (std::vector<std::string>{"wide", "narrow"}));
  ASSERT_EQ(read.sequences.size(), 2u);
  EXPECT_EQ(read.sequences[0].name, "bridge");
  EXPECT_EQ(read.sequences[0].folders, (std::vector<std::string>{"bridge/01_day", "Bridge_01_Day"}));
}

TEST_F(ManifestTest, FindsRecordingsHoweverTheirFoldersAreSpelt) {
  make_recording(folder_ / "data" / "some" / "Bridge" / "01-Day", 3);
  make_recording(folder_ / "data" / "Library 01 Day");  // not asked for in this form
  make_recording(folder_ / "data" / "library" / "01_DAY");
  const Sequences opened = open_manifest(manifest(kList), folder_ / "data", {}, folder_ / "out");
  ASSERT_EQ(opened.sequences.size(), 2u);
  EXPECT_TRUE(opened.skipped.empty());
  EXPECT_EQ(opened.sequences[0].label, "bridge");
  EXPECT_EQ(opened.sequences[0].scans, 3u);
  EXPECT_EQ(opened.sequences[1].label, "library");
  EXPECT_EQ(opened.sequences[1].path, fs::canonical(folder_ / "data" / "library" / "01_DAY"));
}

TEST_F(ManifestTest, TheRootMayBeAPartOfThePath) {
  make_recording(folder_ / "bridge" / "01_day");
  const Sequences opened = open_manifest(manifest(kList), folder_ / "bridge", {}, folder_ / "out");
  ASSERT_EQ(opened.sequences.size(), 1u);
  EXPECT_EQ(opened.sequences[0].label, "bridge");
}

TEST_F(ManifestTest, WhatIsNotThereIsTold) {
  make_recording(folder_ / "data" / "bridge" / "01_day");
  fs::create_directories(folder_ / "data" / "library" / "01_day");
  const Sequences opened = open_manifest(manifest(kList), folder_ / "data", {}, folder_ / "out");
  EXPECT_EQ(opened.sequences.size(), 1u);
  ASSERT_EQ(opened.skipped.size(), 1u);
  EXPECT_NE(opened.skipped[0].reason.find("library"), std::string::npos) << opened.skipped[0].reason;
  fs::remove_all(folder_ / "data" / "bridge");
  try {
    open_manifest(manifest(kList), folder_ / "data", {}, folder_ / "out");
    FAIL() << "nothing is there";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("'bridge/01_day' or 'Bridge_01_Day'"), std::string::npos) << error.what();
  }
  EXPECT_THROW(open_manifest(manifest(kList), folder_ / "nowhere", {}, folder_ / "out"), DataError);
}

TEST_F(ManifestTest, RefusesWhatItDoesNotKnow) {
  EXPECT_NE(refusal<UsageError>(kList + "speed: 3\n").find("speed"), std::string::npos);
  EXPECT_NE(refusal<UsageError>("description: d\nformat: dicp\n").find("sequences"), std::string::npos);
  EXPECT_NE(refusal<UsageError>(kList + "  - {name: bridge, folders: [x]}\n").find("second time"), std::string::npos);
  EXPECT_NE(refusal<UsageError>(kList + "  - {name: a/b, folders: [x]}\n").find("slash"), std::string::npos);
  const auto named = [&](const std::string& name) {
    return refusal<UsageError>(kList + "  - {name: " + name + ", folders: [x]}\n");
  };
  for (const char* name : {"'.'", "'..'", ".hidden"}) {
    EXPECT_NE(named(name).find("begins with a dot"), std::string::npos) << named(name);
  }
  for (const char* name : {"tables", "tables.md", "results.json", "benchmark.lock", "report.html"}) {
    EXPECT_NE(named(name).find("is that of a file of the benchmark itself"), std::string::npos) << named(name);
  }
  for (const char* name : {R"("a\n")", R"("\e[31m")", R"("\x9b31m")", R"("\x7f")"}) {
    EXPECT_NE(named(name).find("holds a control character"), std::string::npos) << named(name);
  }
  EXPECT_NE(named(std::string(300, 'a')).find("longer than 200 bytes"), std::string::npos);
  EXPECT_EQ(named("'=x, é 1.0'"), "taken");
  EXPECT_NE(refusal<UsageError>(kList + R"(  - {name: c, folders: ["\e[31m"]})").find("control character"),
            std::string::npos);
  EXPECT_NE(refusal<UsageError>(kList + "  - {name: c, folders: []}\n").find("folders"), std::string::npos);
}

TEST_F(ManifestTest, ThoseOfThePaperAreWhatThePaperNames) {
  const fs::path folder = fs::path(DYNAMIC_ICP_SOURCE_FOLDER) / "manifests";
  const auto read = [&](const char* name) { return read_manifest(folder / name); };
  EXPECT_EQ(read("paper-hercules.yaml").sequences.size(), 6u);
  EXPECT_EQ(read("paper-helipr.yaml").sequences.size(), 6u);
  EXPECT_EQ(read("paper-aevascenes-highway.yaml").sequences.size(), 44u);
  EXPECT_EQ(read("paper-aevascenes-city.yaml").sequences.size(), 43u);
  EXPECT_EQ(read("paper-dicp.yaml").sequences.size(), 1u);
  for (const char* name : {"paper-aevascenes-highway.yaml", "paper-aevascenes-city.yaml"}) {
    EXPECT_EQ(read(name).lidars, (std::vector<std::string>{"front_wide_lidar", "front_narrow_lidar"}));
  }
}

}  // namespace
}  // namespace dynamic_icp::benchmark
