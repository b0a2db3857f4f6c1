// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/results.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::benchmark {
namespace {

/// Every member with a value of its own, so that no two can be mistaken for each other.
CellResult full_cell() {
  CellResult cell;
  cell.key = {"street 1", "gicp", "none"};
  cell.finished = true;
  cell.folder = "street 1/gicp";
  cell.frames = 12;
  cell.rte_rmse_m = 0.1;
  cell.rre_rmse_deg = 0.2;
  cell.ate_rmse_m = 0.3;
  cell.path_length_m = 1.0 / 3.0;
  cell.nees_rotation = 3.25;
  cell.nees_translation = 2.75;
  cell.beyond_4_sigma = 0.125;
  cell.mean_iterations = 5.5;
  cell.convergence_rate = 0.75;
  cell.ms_mean = 21.0;
  cell.ms_median = 20.0;
  cell.ms_p95 = 30.0;
  cell.fps = 47.6;
  cell.peak_memory_mib = 99.0;
  cell.dynamic_ratio_max = 0.4;
  cell.dynamic_ratio_mean = 0.35;
  cell.clustered_ratio_mean = 0.6;
  cell.refined_ratio_mean = 0.7;
  cell.objects = {1.0, 2.0, 0.03, 0.9, 0.25};
  cell.tracks = {0.7, 0.65, 0.8, 1.25, 33.0, 0.41, 0.72, 2.26, 0.31, 0.24, 0.63, 3.14, 2.96, 0.15};
  cell.notes = {"a scan period of 0.1 s is assumed", "\"quoted\""};
  cell.warnings = 4;
  cell.jobs = 3;
  cell.processor = "another processor";
  return cell;
}

void expect_equal(const CellResult& a, const CellResult& b) {
  EXPECT_EQ(a.key, b.key);
  EXPECT_EQ(a.finished, b.finished);
  EXPECT_EQ(a.failure, b.failure);
  EXPECT_EQ(a.folder, b.folder);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.rte_rmse_m, b.rte_rmse_m);
  EXPECT_EQ(a.rre_rmse_deg, b.rre_rmse_deg);
  EXPECT_EQ(a.ate_rmse_m, b.ate_rmse_m);
  EXPECT_EQ(a.path_length_m, b.path_length_m);
  EXPECT_EQ(a.nees_rotation, b.nees_rotation);
  EXPECT_EQ(a.nees_translation, b.nees_translation);
  EXPECT_EQ(a.beyond_4_sigma, b.beyond_4_sigma);
  EXPECT_EQ(a.mean_iterations, b.mean_iterations);
  EXPECT_EQ(a.convergence_rate, b.convergence_rate);
  EXPECT_EQ(a.ms_mean, b.ms_mean);
  EXPECT_EQ(a.ms_median, b.ms_median);
  EXPECT_EQ(a.ms_p95, b.ms_p95);
  EXPECT_EQ(a.fps, b.fps);
  EXPECT_EQ(a.peak_memory_mib, b.peak_memory_mib);
  EXPECT_EQ(a.dynamic_ratio_max, b.dynamic_ratio_max);
  EXPECT_EQ(a.dynamic_ratio_mean, b.dynamic_ratio_mean);
  EXPECT_EQ(a.clustered_ratio_mean, b.clustered_ratio_mean);
  EXPECT_EQ(a.refined_ratio_mean, b.refined_ratio_mean);
  EXPECT_EQ(a.objects.along_mae_mps, b.objects.along_mae_mps);
  EXPECT_EQ(a.objects.lateral_mae_mps, b.objects.lateral_mae_mps);
  EXPECT_EQ(a.objects.median_relative_error, b.objects.median_relative_error);
  EXPECT_EQ(a.objects.estimated_share, b.objects.estimated_share);
  EXPECT_EQ(a.objects.false_per_scan, b.objects.false_per_scan);
  EXPECT_EQ(a.tracks.hota, b.tracks.hota);
  EXPECT_EQ(a.tracks.mota, b.tracks.mota);
  EXPECT_EQ(a.tracks.idf1, b.tracks.idf1);
  EXPECT_EQ(a.tracks.switches_per_100_s, b.tracks.switches_per_100_s);
  EXPECT_EQ(a.tracks.false_per_1000_scans, b.tracks.false_per_1000_scans);
  EXPECT_EQ(a.tracks.along_mps, b.tracks.along_mps);
  EXPECT_EQ(a.tracks.across_mps, b.tracks.across_mps);
  EXPECT_EQ(a.tracks.heading_deg, b.tracks.heading_deg);
  EXPECT_EQ(a.tracks.center_m, b.tracks.center_m);
  EXPECT_EQ(a.tracks.size_m, b.tracks.size_m);
  EXPECT_EQ(a.tracks.overlap, b.tracks.overlap);
  EXPECT_EQ(a.tracks.nees_velocity, b.tracks.nees_velocity);
  EXPECT_EQ(a.tracks.nees_center, b.tracks.nees_center);
  EXPECT_EQ(a.tracks.latency_s, b.tracks.latency_s);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.jobs, b.jobs);
  EXPECT_EQ(a.processor, b.processor);
}

TEST(Results, ACellReadsBackAsItWas) {
  expect_equal(cell_from_json(to_json(full_cell()), "cell.json"), full_cell());
  CellResult failed;
  failed.key = {"a", "kiss-icp", "none"};
  failed.failure = "killed by signal 9 (Killed)";
  expect_equal(cell_from_json(to_json(failed), "cell.json"), failed);
}

TEST(Results, ABenchmarkReadsBackAsItWas) {
  const BenchmarkInfo info{"0.1.0",   "dynamic-icp benchmark 'my data'", "a machine", 4, 2, "paper",
                           {"a.b=3"}, {{"x", "/d/x"}, {"y", "/d/y"}}};
  const BenchmarkResults read = results_from_json(to_json(BenchmarkResults{info, {full_cell(), {}}}), "results.json");
  EXPECT_EQ(read.info.version, info.version);
  EXPECT_EQ(read.info.command, info.command);
  EXPECT_EQ(read.info.machine, info.machine);
  EXPECT_EQ(read.info.threads, info.threads);
  EXPECT_EQ(read.info.jobs, info.jobs);
  EXPECT_EQ(read.info.preset, info.preset);
  EXPECT_EQ(read.info.settings, info.settings);
  EXPECT_EQ(read.info.sequences, info.sequences);
  ASSERT_EQ(read.cells.size(), 2u);
  expect_equal(read.cells[0], full_cell());
}

TEST(Results, NamesThatAreNotUtf8DoNotStopTheWriting) {
  BenchmarkResults results;
  results.info.sequences = {{"a\xff", "/d/a\xff"}};
  EXPECT_NO_THROW(results_from_json(to_json(results), "results.json"));
}

TEST(Results, OfOlderVersionsHaveNoTracks) {
  std::string older = to_json(full_cell());
  for (std::size_t at = 0; (at = older.find("\"tracks_")) != std::string::npos;) {
    older.erase(at, older.find(',', at) + 1 - at);
  }
  CellResult expected = full_cell();
  expected.tracks = {};
  expect_equal(cell_from_json(older, "cell.json"), expected);
}

TEST(Results, RefusalsNameTheFileAndWhatIsMissing) {
  std::string lacking = to_json(BenchmarkResults{{}, {full_cell()}});
  lacking.replace(lacking.find("\"fps\""), 5, "\"fpz\"");
  std::string wrong = to_json(BenchmarkResults{{}, {full_cell()}});
  wrong.replace(wrong.find("47.6"), 4, "\"47\"");
  for (const auto& [text, word] : {std::pair<std::string, std::string>{"", "parse"},
                                   {"{}", "info"},
                                   {"[]", "array"},
                                   {"{\"info\": {}}", "version"},
                                   {lacking, "fps"},
                                   {wrong, "number"}}) {
    try {
      results_from_json(text, "/d/results.json");
      ADD_FAILURE() << text;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find("/d/results.json"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::benchmark
