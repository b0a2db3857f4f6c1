// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_report.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"

#include "testing/read_blob.hpp"
#include "testing/read_page.hpp"
#include "testing/wall_drive.hpp"
#include "testing/well_formed.hpp"

namespace dynamic_icp::report {
namespace {

using nlohmann::json;

constexpr ViewerBundle kBundle{.script = "start();", .style = "body{}"};

std::string html_of(const runs::TestFolder& folder, const ScanChoice& choice = {}) {
  return html_page(run_report(folder.path() / "run", choice, Workers(1)), kBundle);
}

void replace(const runs::TestFolder& folder, const std::string& file, const std::string& from, const std::string& to) {
  std::string content = folder.read(file);
  ASSERT_NE(content.find(from), std::string::npos) << from;
  content.replace(content.find(from), from.size(), to);
  folder.write(file, content);
}

std::string message_of(const runs::TestFolder& folder) {
  try {
    html_of(folder);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RunReport, HoldsWhatTheContractNames) {
  const runs::TestFolder folder;
  const WallDrive drive;
  drive.write(folder);
  const ReadPage page = read_page(html_of(folder));
  EXPECT_EQ(page.programs, 1);
  const json& report = page.report;
  EXPECT_EQ(report["schema"], 1);
  EXPECT_EQ(report["kind"], "run");
  EXPECT_EQ(report["title"], "drive");
  EXPECT_EQ(report["generator"], generator());
  EXPECT_EQ(report["notes"], json::array());
  ASSERT_EQ(report["runs"].size(), 1u);
  const json& run = report["runs"][0];
  EXPECT_EQ(run["name"], "drive");
  EXPECT_EQ(run["facts"], json::parse(R"([["method","dynamic-icp"],["preset","default"],["version","0.1.0"]])"));
  EXPECT_EQ(run["command"], "dynamic-icp run drive");
  EXPECT_EQ(run["summary"][2]["key"], "rte_rmse_m");
  EXPECT_EQ(run["summary"][2]["value"], "0 mm");
  EXPECT_EQ(run["summary"][2]["number"], 0.0);
  EXPECT_EQ(run["summary"][2]["better"], "lower");
  EXPECT_TRUE(run["summary"][1]["better"].is_null()) << "more scans are no better ones";

  const json& frames = run["frames"];
  for (const char* key : {"index", "seconds", "status", "reason", "lost_directions", "objects"}) {
    EXPECT_EQ(frames[key].size(), drive.frames) << key;
  }
  ASSERT_EQ(frames["poses"].size(), 7 * drive.frames);
  EXPECT_EQ(frames["poses"][7 * 3], 3.0);
  EXPECT_EQ(frames["poses"][7 * 3 + 6], 1.0) << "w comes last";
  EXPECT_EQ(frames["ego_velocity"].size(), 3 * drive.frames);
  EXPECT_EQ(frames["status"][0], "first");
  EXPECT_EQ(frames["status"][1], "ok");
  EXPECT_EQ(frames["reason"][1], "") << "nothing to say of what went well";
  EXPECT_EQ(frames["objects"][2], json::parse("[[7,15,0,0,21,0,-0.75,4,2,1.5,0,300]]"));
  EXPECT_EQ(run["truth"]["poses"].size(), 7 * drive.frames);
  EXPECT_EQ(run["truth"]["poses"][7 * 5], 5.0);

  std::set<std::string> ids;
  for (const json& plot : run["plots"]) {
    ids.insert(plot["id"].get<std::string>());
    for (const char* key : {"title", "unit", "log", "from_zero", "whole_numbers", "levels"}) {
      EXPECT_TRUE(plot.contains(key)) << key;
    }
    for (const json& series : plot["series"]) {
      EXPECT_EQ(series["values"].size(), drive.frames);
      EXPECT_TRUE(series["broad"].is_boolean() && series["name"].is_string());
    }
  }
  EXPECT_EQ(
      ids, (std::set<std::string>{"ego_speed", "translation_error", "rotation_error", "position_error", "iterations",
                                  "inlier_rmse", "fitness", "degeneracy", "dynamic_share", "objects", "milliseconds"}));
  for (std::size_t k = 0; k < drive.frames; ++k) {
    EXPECT_NEAR(run["frames"]["distance"][k].get<double>(), WallDrive::kEgo_mps * WallDrive::seconds(k), 1e-4);
  }
  EXPECT_EQ(run["stretches"]["length"], json::parse("[1,2,5]"));
  EXPECT_EQ(run["stretches"]["translation"], json::parse("[0,0,0]")) << "a perfect run";

  const json& scans = run["scans"];
  ASSERT_EQ(scans["frames"].size(), drive.frames);
  for (std::size_t k = 0; k < drive.frames; ++k) {
    const ReadScan scan = read_scan_blob(page.data.at("scan-0-" + std::to_string(k)));
    EXPECT_EQ(scan.points.size(), scans["points"][k]);
    EXPECT_EQ(scans["of"][k], drive.points);
    EXPECT_EQ(scans["whole"][k], true);
  }
  EXPECT_EQ(read_map_blob(page.data.at("map-0")).size(), run["map"]["points"]);
  EXPECT_EQ(read_map_blob(page.data.at("traces-0")).size(), run["traces"]["points"]);
  EXPECT_EQ(page.data.size(), drive.frames + 3) << "report, map, traces and scans, nothing else";
}

TEST(RunReport, WhatIsShownFirstStandsBeforeTheViewerAndTheRestBehindIt) {
  const runs::TestFolder folder;
  WallDrive drive;
  drive.frames = 9;
  drive.write(folder);
  const std::string html = html_of(folder);
  const json scans = read_page(html).report["runs"][0]["scans"];
  EXPECT_EQ(scans["first"], 2) << "the first with the car in it, a quarter of the way into the drive";
  const std::size_t viewer = html.find("start();");
  for (std::size_t k = 0; k < drive.frames; ++k) {
    EXPECT_EQ(html.find(fmt::format("id=\"scan-0-{}\"", k)) < viewer, k == 0 || k == 2) << k;
  }
  EXPECT_LT(html.find("id=\"report\""), viewer);
  EXPECT_GT(html.find("id=\"map-0\""), viewer);
}

TEST(RunReport, NeedsNothingFromOutside) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  const std::string html = html_of(folder);
  for (const char* text : {"src=", "href=", "url(", "@import", "http:", "https:"}) {
    EXPECT_EQ(drawing::count_of(html, text), 0u) << text;
  }
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(RunReport, TellsOfFailureAndStopOnlyWhereTheyHappened) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  const std::string nothing = R"("failure":null,"stopped":false)";
  replace(folder, "run/summary.json", R"("rte_rmse_m":0.0)", nothing);
  const auto tells_of = [&](const std::string& key) {
    const json report = read_page(html_of(folder)).report;
    const json& rows = report["runs"][0]["summary"];
    return std::any_of(rows.begin(), rows.end(), [&](const json& row) { return row["key"] == key; });
  };
  EXPECT_FALSE(tells_of("failure"));
  EXPECT_FALSE(tells_of("stopped"));
  replace(folder, "run/summary.json", nothing, R"("failure":"lost","stopped":true)");
  EXPECT_TRUE(tells_of("failure"));
  EXPECT_TRUE(tells_of("stopped"));
}

TEST(RunReport, ShowsHostileTextAsText) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  const std::string hostile = R"(</script><script>alert(1)</script><!--<script> & \u2028 'x')";
  const std::string in_json = json(hostile).dump();
  replace(folder, "run/run.json", R"("dynamic-icp run drive")", in_json);
  replace(folder, "run/run.json", R"("configuration":{})", "\"configuration\":{" + in_json + ":" + in_json + "}");
  replace(folder, "run/run.json", R"("preset":"default")",
          "\"preset\":" + in_json + ",\"warnings\":[" + in_json + "]," + in_json + ":1");
  replace(folder, "run/summary.json", R"("rte_rmse_m":0.0)", in_json + ":" + in_json);
  replace(folder, "run/frames.jsonl", R"("reason":"converged")", "\"reason\":" + in_json);
  replace(folder, "run/frames.jsonl", R"("preprocess":1.5)", in_json + ":1.5");
  const std::string html = html_of(folder);
  const ReadPage page = read_page(html);
  EXPECT_EQ(page.programs, 1);
  EXPECT_EQ(drawing::count_of(html, "alert(1)</"), 0u);
  EXPECT_EQ(drawing::count_of(html, "<!--"), 0u);
  const json& run = page.report["runs"][0];
  EXPECT_EQ(run["command"], hostile);
  EXPECT_EQ(run["configuration"][0][1], hostile);
  EXPECT_EQ(run["facts"][1][1], hostile);
  EXPECT_EQ(run["summary"][2]["value"], hostile);
  EXPECT_EQ(run["frames"]["reason"][1], hostile);
  EXPECT_NE(html.find("&lt;/script&gt;&lt;script&gt;alert(1)"), std::string::npos) << "without JavaScript as well";
}

TEST(RunReport, TextsThatAreNoUtf8AreMended) {
  Json report = {
      {"schema", 1}, {"kind", "run"}, {"title", "a\xFF<b>"}, {"notes", Json::array()}, {"runs", Json::array()}};
  const ReadPage page = read_page(html_page({report, {}}, kBundle));
  EXPECT_EQ(page.report["title"], "a\xEF\xBF\xBD<b>");
  EXPECT_THROW(html_page({report, {}}, {.script = "'</script>'", .style = ""}), std::runtime_error);
}

TEST(RunReport, TakesRunsWithNoneAndOneScan) {
  for (const std::size_t frames : {0u, 1u, 2u}) {
    const runs::TestFolder folder;
    WallDrive drive;
    drive.frames = frames;
    drive.write(folder);
    const ReadPage page = read_page(html_of(folder));
    const json& run = page.report["runs"][0];
    EXPECT_EQ(run["frames"]["index"].size(), frames);
    EXPECT_EQ(run["scans"].is_null(), frames == 0);
    EXPECT_EQ(page.report["notes"].empty(), frames > 0) << page.report["notes"].dump();
  }
}

TEST(RunReport, WithoutRecordingThereAreNoScansButANote) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  std::filesystem::remove_all(folder.path() / "drive");
  const ReadPage page = read_page(html_of(folder));
  EXPECT_TRUE(page.report["runs"][0]["scans"].is_null());
  EXPECT_TRUE(page.report["runs"][0]["map"].is_null());
  EXPECT_TRUE(page.report["runs"][0]["traces"].is_null());
  EXPECT_TRUE(page.report["runs"][0]["truth"].is_null());
  ASSERT_EQ(page.report["notes"].size(), 2u);
  EXPECT_NE(page.report["notes"][0].get<std::string>().find("No scans are shown"), std::string::npos);
  EXPECT_EQ(page.data.size(), 1u);
}

TEST(RunReport, RecordingThatChangedIsANote) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  folder.write("drive/point_clouds/00003.bin", std::string(64, '\0'));
  const ReadPage page = read_page(html_of(folder));
  EXPECT_TRUE(page.report["runs"][0]["scans"].is_null());
  ASSERT_EQ(page.report["notes"].size(), 1u);
  EXPECT_NE(page.report["notes"][0].get<std::string>().find("the recording has changed"), std::string::npos);
}

TEST(RunReport, LabelsThatDoNotFitAreANote) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  std::filesystem::remove(folder.path() / "run/labels/00002.bin");
  const ReadPage without = read_page(html_of(folder));
  EXPECT_NE(without.report["notes"][0].get<std::string>().find("labels/ lacks 1 of"), std::string::npos);
  folder.write("run/labels/00002.bin", "xyz");
  const ReadPage page = read_page(html_of(folder));
  EXPECT_TRUE(page.report["runs"][0]["scans"].is_null());
  EXPECT_NE(page.report["notes"][0].get<std::string>().find("labels/00002.bin"), std::string::npos);
}

TEST(RunReport, NamesWhatIsMissingOrCutOff) {
  for (const char* file : {"trajectory.tum", "frames.jsonl", "objects.jsonl", "summary.json", "run.json"}) {
    const runs::TestFolder folder;
    WallDrive().write(folder);
    const std::string content = folder.read(std::string("run/") + file);
    folder.write(std::string("run/") + file, content.substr(0, content.size() - 12));
    EXPECT_NE(message_of(folder).find(file), std::string::npos) << file << ": " << message_of(folder);
    std::filesystem::remove(folder.path() / "run" / file);
    EXPECT_NE(message_of(folder).find(file), std::string::npos) << file << ": " << message_of(folder);
  }
}

TEST(RunReport, NumbersThatNobodyMeasuredAreNoReasonToFail) {
  const std::pair<const char*, const char*> faults[] = {
      {"frames.jsonl", R"("linear":[10,0,0])"},       {"frames.jsonl", R"("angular":[0,0,0])"},
      {"frames.jsonl", R"("ego_velocity":[10,0,0])"}, {"objects.jsonl", R"("velocity":[15,0,0])"},
      {"objects.jsonl", R"("extent":[4,2,1.5])"},     {"frames.jsonl", R"("points":3000)"},
      {"frames.jsonl", R"("points_used":3000)"},      {"frames.jsonl", R"("index":1)"}};
  for (const bool save_labels : {true, false}) {
    for (const auto& [file, text] : faults) {
      for (const char* number : {"1e300", "-1e300", "null", "-1"}) {
        const runs::TestFolder folder;
        WallDrive drive;
        drive.sweep_s = 0.09;
        drive.save_labels = save_labels;
        drive.write(folder);
        const std::string key = std::string(text).substr(0, std::string(text).find(':') + 1);
        const bool is_vector = std::string(text).back() == ']';
        const bool is_whole = key == "\"index\":";
        replace(folder, std::string("run/") + file, text,
                key + (is_vector  ? fmt::format("[{0},{0},{0}]", number)
                       : is_whole ? "123456"
                                  : number));
        const ReadPage page = read_page(html_of(folder));
        EXPECT_EQ(page.report["runs"][0]["frames"]["index"].size(), drive.frames) << text << number;
      }
    }
  }
}

TEST(RunReport, TakesRunsOfAVersionThatSaidLess) {
  const runs::TestFolder folder;
  WallDrive().write(folder);
  std::string rows = folder.read("run/frames.jsonl");
  for (const std::string part :
       {R"("information_ratio":0.5,"degenerate":[],)", R"("twist":{"angular":[0,0,0],"linear":[10,0,0]},)"}) {
    for (std::size_t at = rows.find(part); at != std::string::npos; at = rows.find(part)) {
      rows.erase(at, part.size());
    }
  }
  folder.write("run/frames.jsonl", rows);
  replace(folder, "run/run.json", R"("version":"0.1.0")", R"("version":"9.0.0","news":{"unknown":[1,{"a":null}]})");
  const ReadPage page = read_page(html_of(folder));
  EXPECT_EQ(page.report["runs"][0]["facts"][2][1], "9.0.0");
  EXPECT_FALSE(page.report["runs"][0]["scans"].is_null());
}

TEST(RunFacts, CountScansThatWentWrong) {
  runs::RunFiles run;
  for (std::size_t k = 0; k < 5; ++k) {
    runs::FrameRow row;
    row.index = k;
    row.reason = k == 0 ? "first" : k == 2 ? "time_gap" : "degenerate";
    run.frames.push_back(row);
  }
  run.warnings = {"a warning"};
  EXPECT_EQ(warnings_of(run), (std::vector<std::string>{"3 of 5 scans: degenerate (scan 1, 3, 4)",
                                                        "1 of 5 scans: time gap (scan 2)", "a warning"}));
}

TEST(RunFacts, SayWhichDirectionIsNotHeld) {
  Vector6d direction = Vector6d::Zero();
  direction[3] = -1.0;
  EXPECT_EQ(direction_text(direction), "position forwards");
  direction << 0.0, 0.05, 1.0, 0.1, 0.0, 0.0;
  EXPECT_EQ(direction_text(direction), "yaw");
  direction << 0.0, 0.0, 0.0, 0.6, 0.8, 0.0;
  EXPECT_EQ(direction_text(direction), "position along (0.6, 0.8, 0)");
}

}  // namespace
}  // namespace dynamic_icp::report
