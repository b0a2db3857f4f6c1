// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/comparison_report.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/benchmark/results.hpp"

#include "testing/read_page.hpp"
#include "testing/wall_drive.hpp"

namespace dynamic_icp::report {
namespace {

using nlohmann::json;

constexpr ViewerBundle kViewer{.script = "start();", .style = ""};

/// A copy of run/ that says another method.
void copy_run(const runs::TestFolder& folder, const std::string& name, const std::string& method) {
  std::filesystem::create_directories((folder.path() / name).parent_path());
  std::filesystem::copy(folder.path() / "run", folder.path() / name, std::filesystem::copy_options::recursive);
  std::string about = folder.read(name + "/run.json");
  const std::string before = R"("method":"dynamic-icp")";
  about.replace(about.find(before), before.size(), "\"method\":\"" + method + "\"");
  folder.write(name + "/run.json", about);
}

TEST(ComparisonReport, GroupsRunsOverTheSameRecording) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  copy_run(folder, "b", "gicp");
  copy_run(folder, "c", "gicp");
  std::string about = folder.read("c/run.json");
  const std::string path = (folder.path() / "drive").string();
  about.replace(about.find(path), path.size(), (folder.path() / "other").string());
  folder.write("c/run.json", about);
  folder.write("b/report.html", "");
  const ReadPage page =
      read_page(html_page(comparison_report({folder.path() / "run", folder.path() / "b/", folder.path() / "c"},
                                            folder.path() / "comparison.html"),
                          kViewer));
  EXPECT_EQ(page.report["kind"], "comparison");
  ASSERT_EQ(page.report["runs"].size(), 3u);
  EXPECT_EQ(page.report["groups"], json::parse(R"([{"name":"drive","runs":[0,1]},{"name":"other","runs":[2]}])"));
  EXPECT_EQ(page.report["runs"][0]["name"], "dynamic-icp");
  EXPECT_EQ(page.report["runs"][1]["name"], "gicp");
  for (const json& run : page.report["runs"]) {
    EXPECT_TRUE(run["scans"].is_null() && run["map"].is_null());
  }
  EXPECT_FALSE(page.report["runs"][1]["truth"].is_null());
  EXPECT_TRUE(page.report["runs"][0]["page"].is_null());
  EXPECT_EQ(page.report["runs"][1]["page"], "b/report.html");
  ASSERT_EQ(page.report["runs"][1]["worst"].size(), 5u);
  EXPECT_EQ(page.report["runs"][1]["worst"][0]["status"], "ok");
  EXPECT_EQ(page.report["runs"][1]["colour"], 2) << "of gicp everywhere";
  EXPECT_EQ(page.data.size(), 1u);
}

/// The numbers of points of the scans of run/, which differ as those of real scans do.
void vary_points(const runs::TestFolder& folder) {
  std::string frames = folder.read("run/frames.jsonl");
  std::size_t scan = 0;
  for (std::size_t at = 0; (at = frames.find(R"("points":)", at)) != std::string::npos; at += 10) {
    frames.insert(at + 9, std::to_string(++scan));
  }
  folder.write("run/frames.jsonl", frames);
}

TEST(ComparisonReport, ContainersOfOneRecordingAreLaidOverEachOtherAndTheirDifferenceTold) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  vary_points(folder);
  copy_run(folder, "b", "dynamic-icp");
  std::string about = folder.read("b/run.json");
  const std::string path = (folder.path() / "drive").string();
  about.replace(about.find(path), path.size(), (folder.path() / "drive.mcap").string());
  const std::string format = R"("format":"dicp")";
  about.replace(about.find(format), format.size(), R"("format":"mcap")");
  folder.write("b/run.json", about);
  std::string trajectory = folder.read("b/trajectory.tum");
  const std::size_t pose = trajectory.find(" 2 0 0 ");  // one pose 4 mm to the left
  ASSERT_NE(pose, std::string::npos);
  trajectory.replace(pose, 7, " 2 0.004 0 ");
  folder.write("b/trajectory.tum", trajectory);
  const PageContent page = comparison_report({folder.path() / "run", folder.path() / "b"}, "comparison.html");
  ASSERT_EQ(page.report["groups"].size(), 1u);
  EXPECT_EQ(page.report["groups"][0]["runs"], Json::parse("[0,1]"));
  EXPECT_EQ(page.report["groups"][0]["differences"],
            Json::parse(R"([{"runs":[0,1],"scans":6,"translation_mm":4,"rotation_deg":0}])"));
  EXPECT_EQ(page.report["runs"][0]["name"], "dicp");
  EXPECT_EQ(page.report["runs"][1]["name"], "mcap");
}

TEST(ComparisonReport, EqualRunsAreToldApartByTheirFolders) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  copy_run(folder, "b", "dynamic-icp");
  const PageContent page = comparison_report({folder.path() / "run", folder.path() / "b"}, "comparison.html");
  EXPECT_EQ(page.report["runs"][0]["name"], "run");
  EXPECT_EQ(page.report["runs"][1]["name"], "b");
}

TEST(ComparisonReport, NamesTheFolderThatIsNoRun) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  try {
    comparison_report({folder.path() / "run", folder.path() / "drive"}, "comparison.html");
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("drive/run.json"), std::string::npos) << error.what();
  }
}

TEST(BenchmarkReport, HoldsTablesGroupsAndFailures) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  benchmark::BenchmarkResults results;
  results.info.version = "0.1.0";
  results.info.sequences = {{"one", "drive"}, {"two", "drive"}};
  for (const char* sequence : {"one", "two"}) {
    for (const char* method : {"dynamic-icp", "gicp", "point-to-plane"}) {
      benchmark::CellResult cell;
      cell.key = {sequence, method, "none"};
      cell.folder = std::filesystem::path("bench/cells") / sequence / method;
      cell.finished = std::string(sequence) == "one" || std::string(method) != "gicp";
      cell.failure = cell.finished ? "" : "it <b>crashed</b>";
      cell.frames = 6;
      cell.rte_rmse_m = std::string(method) == "gicp" ? 0.5 : 0.1;
      if (cell.finished) {
        copy_run(folder, (cell.folder / "run").string(), method);
      }
      cell.folder = std::filesystem::path("cells") / sequence / method;
      results.cells.push_back(cell);
    }
  }
  std::filesystem::remove_all(folder.path() / "bench/cells/two/point-to-plane/run");
  folder.write("bench/results.json", to_json(results));
  EXPECT_TRUE(is_benchmark_folder(folder.path() / "bench"));
  EXPECT_FALSE(is_benchmark_folder(folder.path() / "run"));

  const ReadPage page =
      read_page(html_page(benchmark_report(folder.path() / "bench", folder.path() / "bench/report.html"), kViewer));
  EXPECT_EQ(page.report["kind"], "benchmark");
  EXPECT_EQ(page.report["title"], "bench");
  EXPECT_EQ(page.report["groups"], json::parse(R"([{"name":"one","runs":[0,1,2]},{"name":"two","runs":[3]}])"));
  EXPECT_EQ(page.report["runs"].size(), 4u);
  EXPECT_EQ(page.report["runs"][1]["name"], "GICP");
  EXPECT_EQ(page.report["runs"][1]["colour"], 2) << "by its method, whatever it is called here";
  const std::string notes = page.report["notes"].dump();
  EXPECT_NE(notes.find("it <b>crashed</b>"), std::string::npos) << notes;
  EXPECT_NE(notes.find("two/point-to-plane/run: no such folder"), std::string::npos) << notes;

  const json& table = page.report["tables"][0];
  EXPECT_EQ(table["title"], "Accuracy");
  EXPECT_GT(table["columns"].size(), 2u);
  ASSERT_EQ(table["rows"].size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(table["rows"][row].size(), table["columns"].size());
    EXPECT_EQ(table["best"][row].size(), table["columns"].size());
  }
  bool any_is_best = false;
  for (const json& row : table["best"]) {
    for (const json& is_best : row) {
      any_is_best = any_is_best || is_best.get<bool>();
    }
  }
  EXPECT_TRUE(any_is_best);
  EXPECT_NE(table["rows"].dump().find("failed"), std::string::npos);
  folder.write("bench/results.json", "{");
  EXPECT_THROW(benchmark_report(folder.path() / "bench", folder.path() / "bench/report.html"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::report
