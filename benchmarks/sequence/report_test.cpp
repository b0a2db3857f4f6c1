// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp::speed {
namespace {

/// A run whose scans all take so long.
Run steady_run(double ms, double points = 1000.0) {
  Run run;
  run.warm_up_ms = {3.0 * ms, 2.0 * ms, ms};
  run.ms = std::vector<double>(5, ms);
  run.points_mean = points;
  run.loaded_mib = 100.0;
  run.peak_mib = 110.0 + ms;
  for (std::size_t stage = 0; stage < odometry::kStageCount; ++stage) {
    run.stage_p50_ms[std::string(to_string(static_cast<odometry::Stage>(stage)))] = ms / 5.0;
  }
  return run;
}

Setup setup(const std::string& recording, const std::string& preset, int threads) {
  return {recording, "dynamic-icp", preset, threads};
}

TEST(Report, ARowIsTheMedianOfItsRuns) {
  const Row row = summarise(setup("a/b", "paper", 2), {steady_run(20.0), steady_run(10.0), steady_run(90.0)});
  EXPECT_EQ(row.runs, 3U);
  EXPECT_EQ(row.scans, 5U);
  EXPECT_EQ(row.p50_ms.median, 20.0);
  EXPECT_EQ(row.p50_ms.min, 10.0);
  EXPECT_EQ(row.p50_ms.max, 90.0);
  EXPECT_EQ(row.max_ms, 20.0);
  EXPECT_EQ(row.warm_up_ms, (std::vector<double>{60.0, 40.0, 20.0}));
  EXPECT_EQ(row.stage_p50_ms.at("registration"), 4.0);
  EXPECT_EQ(row.peak_mib, 130.0);
  EXPECT_EQ(row.work_mib, 30.0);
}

TEST(Report, SpeedUpIsAgainstOneThreadOfTheSame) {
  std::vector<Row> rows = {
      summarise(setup("a", "default", 2), {steady_run(10.0)}), summarise(setup("b", "default", 1), {steady_run(80.0)}),
      summarise(setup("a", "paper", 1), {steady_run(70.0)}), summarise(setup("a", "default", 1), {steady_run(15.0)}),
      summarise(setup("c", "default", 2), {steady_run(1.0)})};
  compare(rows);
  EXPECT_DOUBLE_EQ(rows[0].speed_up.value(), 1.5);
  EXPECT_DOUBLE_EQ(rows[3].speed_up.value(), 1.0);
  EXPECT_FALSE(rows[4].speed_up.has_value());
}

TEST(Report, EachRunIsComparedWithTheReferenceJustBefore) {
  std::vector<speed::Run> runs = {steady_run(10.0), steady_run(40.0), steady_run(12.0)};
  EXPECT_FALSE(summarise(setup("a", "paper", 1), runs).ratio.has_value());
  // The machine was slow for a while: both took four times as long.
  runs[0].reference_ms = 20.0;
  runs[1].reference_ms = 80.0;
  EXPECT_FALSE(summarise(setup("a", "paper", 1), runs).ratio.has_value());
  runs[2].reference_ms = 20.0;
  EXPECT_DOUBLE_EQ(summarise(setup("a", "paper", 1), runs).ratio.value(), 0.5);
}

TEST(Report, GrowthIsOverTheRecordingsOfOneSetup) {
  std::vector<Row> rows;
  for (const double points : {1000.0, 2000.0, 8000.0}) {
    rows.push_back(summarise(setup(std::to_string(points), "default", 1), {steady_run(0.01 * points, points)}));
    rows.push_back(summarise(setup(std::to_string(points), "paper", 1), {steady_run(1e-6 * points * points, points)}));
  }
  rows.push_back(summarise(setup("once", "paper", 2), {steady_run(1.0)}));
  const std::vector<Growth> growth = growth_of(rows);
  ASSERT_EQ(growth.size(), 2U);
  EXPECT_EQ(growth[0].setup.preset, "default");
  EXPECT_NEAR(growth[0].exponent, 1.0, 1e-12);
  EXPECT_NEAR(growth[1].exponent, 2.0, 1e-12);
  EXPECT_EQ(growth[0].from_points, 1000.0);
  EXPECT_EQ(growth[0].to_points, 8000.0);
}

TEST(Report, RecordingsAreNamedByTheirLastTwoFolders) {
  EXPECT_EQ(short_name("/d/instant/city-31"), "instant/city-31");
  EXPECT_EQ(short_name("instant/city-31/"), "instant/city-31");
  EXPECT_EQ(short_name("city"), "city");
}

TEST(Report, EveryRowHasALineAndAnEntry) {
  std::vector<Row> rows = {summarise(setup("x/a", "default", 1), {steady_run(12.34)})};
  compare(rows);
  for (const std::string& text : {table_text(rows), stage_text(rows)}) {
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
    EXPECT_NE(text.find("x/a"), std::string::npos);
  }
  EXPECT_NE(table_text(rows).find("12.34"), std::string::npos);
  const nlohmann::ordered_json json = json_of(rows);
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["p50_ms"], 12.34);
  EXPECT_TRUE(json[0]["ratio"].is_null());
  EXPECT_EQ(json[0]["speed_up"], 1.0);
}

}  // namespace
}  // namespace dynamic_icp::speed
