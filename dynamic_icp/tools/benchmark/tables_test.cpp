// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/tables.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::benchmark {
namespace {

CellResult cell(const std::string& sequence, const std::string& method, double rte_m,
                const std::string& ablation = "none") {
  CellResult result;
  result.key = {sequence, method, ablation};
  result.finished = true;
  result.frames = 11;
  result.rte_rmse_m = rte_m;
  result.rre_rmse_deg = 1.0 - rte_m;
  return result;
}

CellResult failed_cell(const std::string& sequence, const std::string& method) {
  CellResult result;
  result.key = {sequence, method, "none"};
  result.failure = "no memory";
  return result;
}

BenchmarkResults with(const std::vector<std::string>& sequences, const std::vector<CellResult>& cells) {
  BenchmarkResults results;
  results.info.version = "9.8.7";
  results.info.machine = "a good machine";
  results.info.preset = "paper";
  results.info.settings = {"a.b=3"};
  results.info.threads = 4;
  for (const std::string& label : sequences) {
    results.info.sequences.emplace_back(label, "/data/" + label);
  }
  results.cells = cells;
  return results;
}

/// A row as text, "*" behind the best and "+" behind the second.
std::string row(const Table& table, std::size_t index) {
  std::string text;
  for (const TableCell& cell : table.rows.at(index)) {
    text += (text.empty() ? "" : " | ") + cell.text;
    text += cell.emphasis == Emphasis::kBest ? "*" : cell.emphasis == Emphasis::kSecond ? "+" : "";
  }
  return text;
}

TEST(Tables, OfNothingAreNone) {
  EXPECT_TRUE(all_tables({}).empty());
  EXPECT_TRUE(all_tables(with({"a"}, {})).empty());
}

TEST(Tables, AllNamesAreKnown) {
  const BenchmarkResults none;
  EXPECT_EQ(table_names(),
            (std::vector<std::string>{accuracy_table(none).name, consistency_table(none).name, runtime_table(none).name,
                                      ablation_table(none).name, dynamics_table(none).name, objects_table(none).name,
                                      tracks_table(none).name}));
}

TEST(Tables, AccuracyHasThePapersNamesAndOrder) {
  const Table table = accuracy_table(
      with({"a", "b"}, {cell("a", "dynamic-icp", 0.1), cell("a", "other", 0.3), cell("a", "point-to-point", 0.2),
                        cell("b", "dynamic-icp", 0.5), cell("b", "other", 0.4), failed_cell("b", "point-to-point")}));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(row(table, 0), "ICP (point-to-point) | 0.2000+ | 0.8000+ | failed | failed | - | -");
  EXPECT_EQ(row(table, 1), "Dynamic-ICP | 0.1000* | 0.9000 | 0.5000+ | 0.5000* | 0.3000* | 0.7000+");
  EXPECT_EQ(row(table, 2), "other | 0.3000 | 0.7000* | 0.4000* | 0.6000+ | 0.3500+ | 0.6500*");
  EXPECT_EQ(table.header[1].group, "a");
  EXPECT_EQ(table.header[2].title, "RRE [deg]");
  EXPECT_EQ(table.header[5].group, "Mean");
}

TEST(Tables, ASequenceWithoutTruthDoesNotSpoilTheMean) {
  CellResult without = cell("b", "gicp", 0.0);
  without.rte_rmse_m.reset();
  without.rre_rmse_deg.reset();
  const Table table = accuracy_table(with({"a", "b"}, {cell("a", "gicp", 0.25), without}));
  EXPECT_EQ(row(table, 0), "GICP | 0.2500 | 0.7500 | - | - | 0.2500 | 0.7500");
  EXPECT_NE(table.caption.find("Mean: over 1 of the 2 sequences (a; the others have no number)"), std::string::npos)
      << table.caption;
}

TEST(Tables, TheCaptionSaysOverWhatTheMeanIsWhereRunsFailed) {
  const auto caption = [](const std::vector<CellResult>& cells) {
    return accuracy_table(with({"a", "b", "c"}, cells)).caption;
  };
  const CellResult a = cell("a", "gicp", 0.25);
  const CellResult c = cell("c", "gicp", 0.25);
  EXPECT_NE(caption({a, failed_cell("b", "gicp"), c}).find("Mean: over 2 of the 3 sequences (a, c; "),
            std::string::npos);
  EXPECT_NE(caption({a, failed_cell("b", "gicp"), cell("b", "kiss-icp", 0.1), c}).find("Mean: over all sequences, "),
            std::string::npos)
      << "a method that failed has no mean, the others have theirs over all";
}

TEST(Tables, ManySequencesAreRows) {
  std::vector<std::string> labels;
  std::vector<CellResult> cells;
  for (int i = 0; i < 7; ++i) {
    labels.push_back("s" + std::to_string(i));
    cells.push_back(cell(labels.back(), "gicp", 0.1 * i));
    cells.push_back(cell(labels.back(), "kiss-icp", 0.3));
  }
  const Table table = accuracy_table(with(labels, cells));
  ASSERT_EQ(table.rows.size(), 8u);
  EXPECT_EQ(table.header[1].group, "GICP");
  EXPECT_EQ(row(table, 1), "s1 | 0.1000* | 0.9000+ | 0.3000+ | 0.7000*");
  EXPECT_EQ(row(table, 3), "s3 | 0.3000* | 0.7000* | 0.3000* | 0.7000*");
  EXPECT_EQ(row(table, 7), "Mean | 0.3000* | 0.7000* | 0.3000* | 0.7000*");
}

TEST(Tables, ConsistencyIsThatOfMethodsThatStateACovariance) {
  CellResult ours = cell("a", "dynamic-icp", 0.1);
  ours.nees_rotation = 2.96;
  ours.nees_translation = 1234.5;
  ours.beyond_4_sigma = 0.034;
  const Table table = consistency_table(with({"a", "b"}, {cell("a", "gicp", 0.1), cell("b", "gicp", 0.1), ours}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(row(table, 0), "GICP | - | - | - | - | - | - | - | - | -");
  EXPECT_EQ(row(table, 1), "Dynamic-ICP | 3.0 | 1234.5 | 3.4% | - | - | - | 3.0 | 1234.5 | 3.4%");
  EXPECT_EQ(table.header[3].title, "Beyond 4 sigma");
  EXPECT_TRUE(consistency_table(with({"a"}, {cell("a", "gicp", 0.1)})).rows.empty());
}

TEST(Tables, RuntimeIsOverAllScansOfFinishedSequences) {
  CellResult small = cell("a", "gicp", 0.1);  // 11 scans, 10 pairs
  small.mean_iterations = 4.0;
  small.convergence_rate = 1.0;
  small.ms_mean = 10.0;
  small.ms_median = 9.0;
  small.ms_p95 = 20.0;
  small.peak_memory_mib = 100.0;
  CellResult large = small;  // 31 scans, 30 pairs
  large.key.sequence = "b";
  large.frames = 31;
  large.mean_iterations = 8.0;
  large.convergence_rate = 0.5;
  large.ms_mean = 20.0;
  large.peak_memory_mib = 50.0;
  const Table table = runtime_table(with({"a", "b", "c"}, {small, large, failed_cell("c", "gicp")}));
  // (4 * 10 + 8 * 30) / 40; (10 + 15) / 40; 1000 * 42 / (110 + 620)
  EXPECT_EQ(row(table, 0), "GICP | 7.00 | 62.50% | 57.53 | 9.0 | 20.0 | 100 | 2 of 3");
}

TEST(Tables, AblationHasThePapersRowsAndNeedsOne) {
  const CellResult full = cell("a", "dynamic-icp", 0.1);
  const Table table = ablation_table(with({"a"}, {full, cell("a", "dynamic-icp", 0.1, "no-dr"),
                                                  cell("a", "dynamic-icp", 0.4, "no-vf"), cell("a", "gicp", 0.0)}));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(row(table, 0), "w/o VF | 0.4000+ | 0.6000*");
  EXPECT_EQ(row(table, 1), "w/o DR | 0.1000* | 0.9000+");
  EXPECT_EQ(row(table, 2), "Full | 0.1000* | 0.9000+");
  EXPECT_TRUE(ablation_table(with({"a"}, {full})).rows.empty());
}

TEST(Tables, DynamicsAndObjectsAreThoseOfOurs) {
  CellResult ours = cell("a", "dynamic-icp", 0.1);
  ours.dynamic_ratio_max = 0.357;
  ours.dynamic_ratio_mean = 0.223;
  ours.clustered_ratio_mean = 0.711;
  ours.objects = {0.53, 1.08, 0.0287, 0.9, 0.25};
  const BenchmarkResults results = with(
      {"a", "b", "c"}, {ours, cell("a", "gicp", 0.1), failed_cell("b", "dynamic-icp"), cell("c", "dynamic-icp", 0.1)});
  const Table dynamics = dynamics_table(results);
  ASSERT_EQ(dynamics.rows.size(), 3u);
  EXPECT_EQ(row(dynamics, 0), "a | 35.7% | 22.3% | 71.1% | -");
  EXPECT_EQ(row(dynamics, 1), "b | failed | failed | failed | failed");
  EXPECT_EQ(row(dynamics, 2), "c | - | - | - | -");
  const Table objects = objects_table(results);
  ASSERT_EQ(objects.rows.size(), 2u) << "where there is truth, and where nobody knows";
  EXPECT_EQ(row(objects, 1), "b | failed | failed | failed | failed | failed");
  EXPECT_EQ(row(objects, 0), "a | 0.53 | 1.08 | 2.87% | 90.0% | 0.25");
}

TEST(Tables, TracksAreThoseOfRunsWithBoxes) {
  CellResult ours = cell("a", "dynamic-icp", 0.1);
  ours.tracks = {0.712, 0.655, 0.801, 1.25, 33.34, 0.41, 0.72, 2.26, 0.31, 0.24, 0.63, 3.14, 2.94, 0.1};
  CellResult older = cell("b", "dynamic-icp", 0.1);
  older.objects.estimated_share = 0.5;
  const BenchmarkResults results = with({"a", "b", "c"}, {ours, older, failed_cell("c", "dynamic-icp")});
  const Table table = tracks_table(results);
  ASSERT_EQ(table.rows.size(), 2u) << "of the second nothing is known";
  EXPECT_EQ(row(table, 0),
            "a | 71.2% | 65.5% | 80.1% | 1.25 | 33.3 | 0.41 | 0.72 | 2.3 | 0.31 | 0.24 | 0.63 | 3.1 | 2.9 | 0.10");
  EXPECT_EQ(row(table, 1).substr(0, 19), "c | failed | failed");
  EXPECT_NE(table.caption.find("AevaScenes: another data set"), std::string::npos);
  EXPECT_TRUE(tracks_table(with({"b"}, {older})).rows.empty());
}

TEST(Tables, EveryCaptionSaysWithWhatWhereAndOnWhat) {
  CellResult ours = cell("a", "dynamic-icp", 0.1);
  ours.objects.estimated_share = 0.0;
  ours.tracks.false_per_1000_scans = 0.0;
  ours.jobs = 3;
  ours.notes = {"the sensor sees"};
  ours.processor = "a slow processor";
  const auto tables = all_tables(with({"a"}, {ours, cell("a", "dynamic-icp", 0.1, "no-vf")}));
  EXPECT_EQ(tables.size(), 6u);
  for (const Table& table : tables) {
    for (const char* words :
         {"9.8.7", "preset paper with a.b=3", "a good machine, some runs on a slow processor", "threads of a run: 4",
          "runs at the same time: 3", "Inputs: a in /data.", "Assumed (dynamic-icp): the sensor sees."}) {
      EXPECT_NE(table.caption.find(words), std::string::npos) << table.name << ": " << table.caption;
    }
    for (const auto& cells : table.rows) {
      EXPECT_EQ(cells.size(), table.header.size()) << table.name;
    }
  }
  EXPECT_NE(tables[0].caption.find("RTE, RRE: root mean square"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::benchmark
