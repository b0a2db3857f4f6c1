// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/tables.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "dynamic_icp/tools/benchmark/caption.hpp"
#include "dynamic_icp/tools/benchmark/comparison.hpp"
#include "dynamic_icp/tools/benchmark/number_cells.hpp"
#include "dynamic_icp/tools/benchmark/variants.hpp"

namespace dynamic_icp::benchmark {
namespace {

constexpr const char* kAccuracy = "accuracy";
constexpr const char* kConsistency = "consistency";
constexpr const char* kRuntime = "runtime";
constexpr const char* kAblation = "ablation";
constexpr const char* kDynamics = "dynamics";
constexpr const char* kObjects = "objects";
constexpr const char* kTracks = "tracks";

Table named(const char* name, const char* title) {
  Table table;
  table.name = name;
  table.title = title;
  return table;
}

/// RTE and RRE of the variants.
Table error_comparison(const BenchmarkResults& results, const std::vector<Variant>& variants, const std::string& what) {
  const Style style{.decimals = 4, .best = Best::kLowest};
  return comparison(results, variants,
                    {{"RTE [m]", style, [](const CellResult& cell) { return cell.rte_rmse_m; }},
                     {"RRE [deg]", style, [](const CellResult& cell) { return cell.rre_rmse_deg; }}},
                    what +
                        " RTE, RRE: root mean square of the translation and rotation error of the motion from each "
                        "scan to the next against the ground truth. Best bold, second underlined, per sequence.");
}

bool states_covariance(const CellResult& cell) { return cell.nees_rotation || cell.nees_translation; }

/// A number per method over all its sequences.
struct Total {
  double sum = 0.0;
  double weight = 0.0;

  void add(const std::optional<double>& value, double value_weight) {
    if (value && value_weight > 0.0) {
      sum += *value * value_weight;
      weight += value_weight;
    }
  }
  [[nodiscard]] Number mean() const { return weight > 0.0 ? Number{sum / weight} : Number{}; }
};

struct MethodTotals {
  Total iterations;
  Total convergence;
  Total ms_mean;
  Total ms_median;
  Total ms_p95;
  std::optional<double> peak_memory_mib;
  std::size_t finished = 0;
  std::size_t cells = 0;

  void add(const CellResult& cell) {
    ++cells;
    if (!cell.finished) {
      return;
    }
    ++finished;
    const auto frames = static_cast<double>(cell.frames);
    iterations.add(cell.mean_iterations, frames - 1.0);
    convergence.add(cell.convergence_rate, frames - 1.0);
    ms_mean.add(cell.ms_mean, frames);
    ms_median.add(cell.ms_median, frames);
    ms_p95.add(cell.ms_p95, frames);
    if (cell.peak_memory_mib) {
      peak_memory_mib = std::max(peak_memory_mib.value_or(0.0), *cell.peak_memory_mib);
    }
  }

  [[nodiscard]] Number fps() const {
    const Number ms = ms_mean.mean();
    return ms.value && *ms.value > 0.0 ? Number{1000.0 / *ms.value} : Number{};
  }
};

std::vector<MethodTotals> totals_of(const BenchmarkResults& results, const std::vector<Variant>& variants) {
  std::vector<MethodTotals> totals(variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    for (const CellResult& cell : results.cells) {
      if (cell.key.method == variants[i].method && cell.key.ablation == variants[i].ablation) {
        totals[i].add(cell);
      }
    }
  }
  return totals;
}

/// A column and where its numbers come from.
template <class Source>
struct NumberColumn {
  TableColumn head;
  Style style;
  std::function<Number(const Source&)> number;
};

template <class Source>
void append_columns(Table& table, const std::vector<Source>& sources,
                    const std::vector<NumberColumn<Source>>& columns) {
  for (const NumberColumn<Source>& column : columns) {
    std::vector<Number> numbers;
    for (const Source& source : sources) {
      numbers.push_back(column.number(source));
    }
    const std::vector<TableCell> cells = cells_of(numbers, column.style);
    table.header.push_back(column.head);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      table.rows[i].push_back(cells[i]);
    }
  }
}

NumberColumn<CellResult> cell_column(const TableColumn& head, const Style& style, const Pick& pick) {
  return {head, style, [pick](const CellResult& cell) { return number_of(&cell, pick); }};
}

/// A row per sequence that ours was run on, of those that `wanted` takes.
std::vector<CellResult> start_sequence_rows(Table& table, const BenchmarkResults& results,
                                            const std::function<bool(const CellResult&)>& wanted) {
  table.header = {{"", "Sequence"}};
  std::vector<CellResult> cells;
  for (const auto& [label, path] : results.info.sequences) {
    const CellResult* cell = find_cell(results, {label, kOurMethod, "none"});
    if (cell != nullptr && wanted(*cell)) {
      table.rows.push_back({{label, Emphasis::kNone}});
      cells.push_back(*cell);
    }
  }
  return cells;
}

}  // namespace

Table accuracy_table(const BenchmarkResults& results) {
  Table table =
      error_comparison(results, methods_run(results), "Comparison of the methods under identical preprocessing.");
  table.name = kAccuracy;
  table.title = "Accuracy";
  return table;
}

Table consistency_table(const BenchmarkResults& results) {
  std::vector<Variant> variants = methods_run(results);
  if (std::none_of(results.cells.begin(), results.cells.end(), states_covariance)) {
    variants.clear();
  }
  const Style nees{.decimals = 1};
  Table table = comparison(
      results, variants,
      {{"NEES rot.", nees, [](const CellResult& cell) { return cell.nees_rotation; }},
       {"NEES transl.", nees, [](const CellResult& cell) { return cell.nees_translation; }},
       {"Beyond 4 sigma",
        {.decimals = 1, .percent = true},
        [](const CellResult& cell) { return cell.beyond_4_sigma; }}},
      "Whether errors are as large as the stated covariances. NEES: mean of e^T C^-1 e of the rotation and of the "
      "translation of the motion from each scan to the next; 3 is right, more is overconfident. Beyond 4 sigma: share "
      "of "
      "the scans with status ok that are beyond four stated standard deviations on any axis. -: no covariance.");
  table.name = kConsistency;
  table.title = "Consistency";
  return table;
}

Table runtime_table(const BenchmarkResults& results) {
  Table table = named(kRuntime, "Runtime and convergence");
  table.header = {{"", "Method"}};
  table.caption =
      "Per method over all its finished sequences. Avg. iters: per pair of scans; conv. rate: share of pairs that "
      "converged; FPS: scans over their total time, reading and writing files excluded; ms p50, p95: percentiles of "
      "each sequence, averaged with its number of scans as weight; peak memory: the largest of any process. " +
      setup_text(results);
  const std::vector<Variant> variants = methods_run(results);
  const std::vector<MethodTotals> totals = totals_of(results, variants);
  for (const Variant& variant : variants) {
    table.rows.push_back({{variant.label, Emphasis::kNone}});
  }
  append_columns<MethodTotals>(
      table, totals,
      {{{"", "Avg. iters"}, {2, false, Best::kLowest}, [](const auto& total) { return total.iterations.mean(); }},
       {{"", "Conv. rate"}, {2, true, Best::kHighest}, [](const auto& total) { return total.convergence.mean(); }},
       {{"", "FPS"}, {2, false, Best::kHighest}, [](const auto& total) { return total.fps(); }},
       {{"", "ms p50"}, {1, false, Best::kLowest}, [](const auto& total) { return total.ms_median.mean(); }},
       {{"", "ms p95"}, {1, false, Best::kLowest}, [](const auto& total) { return total.ms_p95.mean(); }},
       {{"", "Peak memory [MiB]"}, {0, false, Best::kLowest}, [](const auto& total) {
          return Number{total.peak_memory_mib};
        }}});
  table.header.push_back({"", "Finished"});
  for (std::size_t i = 0; i < totals.size(); ++i) {
    table.rows[i].push_back({fmt::format("{} of {}", totals[i].finished, totals[i].cells), Emphasis::kNone});
  }
  return table;
}

Table ablation_table(const BenchmarkResults& results) {
  std::vector<Variant> variants = ablations_run(results);
  if (variants.size() < 2) {
    variants.clear();  // the full method alone is no ablation study
  }
  Table table =
      error_comparison(results, variants,
                       "Dynamic-ICP without the velocity filter (VF), without the prediction of dynamic points "
                       "(DPP), without the Doppler residual (DR), and in full.");
  table.name = kAblation;
  table.title = "Ablation";
  return table;
}

Table dynamics_table(const BenchmarkResults& results) {
  Table table = named(kDynamics, "Scene dynamics");
  table.caption =
      "Dyn./All: dynamic candidates over all points used of a scan; Clustered/Dyn.: clustered points over dynamic "
      "candidates; Refined/Dyn.: points in accepted objects, used for prediction, over clustered points. Max and mean "
      "over the scans of a sequence. " +
      setup_text(results);
  const std::vector<CellResult> cells = start_sequence_rows(table, results, [](const CellResult&) { return true; });
  const Style percent{.decimals = 1, .percent = true};
  append_columns<CellResult>(
      table, cells,
      {cell_column({"Dyn./All", "Max"}, percent, [](const CellResult& cell) { return cell.dynamic_ratio_max; }),
       cell_column({"Dyn./All", "Mean"}, percent, [](const CellResult& cell) { return cell.dynamic_ratio_mean; }),
       cell_column({"Clustered/Dyn.", "Mean"}, percent,
                   [](const CellResult& cell) { return cell.clustered_ratio_mean; }),
       cell_column({"Refined/Dyn.", "Mean"}, percent, [](const CellResult& cell) { return cell.refined_ratio_mean; })});
  return table;
}

Table objects_table(const BenchmarkResults& results) {
  Table table = named(kObjects, "Object velocities");
  table.caption =
      "Velocities of moving objects against the truth, for true objects with at least 50 points and 2 m/s after the "
      "first 5 scans; their estimate is the nearest reported object within 3 m beyond half their longest edge. Along, "
      "lateral: mean absolute error along and across the true motion; rel. error: median of the error along the motion "
      "over the true speed; with estimate: share of the true objects; false: reported objects where there is no true "
      "one. " +
      setup_text(results);
  const auto has_truth = [](const CellResult& cell) { return cell.objects.estimated_share.has_value(); };
  const bool any_truth = std::any_of(results.cells.begin(), results.cells.end(), has_truth);
  const std::vector<CellResult> cells = start_sequence_rows(
      table, results, [&](const CellResult& cell) { return has_truth(cell) || (any_truth && !cell.finished); });
  append_columns<CellResult>(
      table, cells,
      {cell_column({"", "Along [m/s]"}, {}, [](const CellResult& cell) { return cell.objects.along_mae_mps; }),
       cell_column({"", "Lateral [m/s]"}, {}, [](const CellResult& cell) { return cell.objects.lateral_mae_mps; }),
       cell_column({"", "Rel. error"}, {2, true},
                   [](const CellResult& cell) { return cell.objects.median_relative_error; }),
       cell_column({"", "With estimate"}, {1, true},
                   [](const CellResult& cell) { return cell.objects.estimated_share; }),
       cell_column({"", "False per scan"}, {}, [](const CellResult& cell) { return cell.objects.false_per_scan; })});
  return table;
}

Table tracks_table(const BenchmarkResults& results) {
  Table table = named(kTracks, "Objects as tracks");
  table.caption =
      "Moving objects with boxes and ids against the truth; true objects count as in the table of their velocities, "
      "and "
      "pair with reported ones by the intersection over union of their boxes. HOTA, MOTA, IDF1 (the last two at an "
      "overlap "
      "of 0.25); switches: changes of id per 100 s in which an object that counts is there; false: reported without a "
      "partner at that overlap, per 1,000 scans. Over pairs, mean absolute errors: of the velocity along and across "
      "the "
      "true motion, of heading, centre and edges (size), the mean overlap, and the mean NEES of velocity and centre (3 "
      "is right, more is overconfident). Latency: median time from when an object counts first to its first report. "
      "The "
      "paper's object validation has MAE along 0.53 m/s and lateral 1.08 m/s, on AevaScenes: another data set. " +
      setup_text(results);
  const auto is_scored = [](const CellResult& cell) { return cell.tracks.false_per_1000_scans.has_value(); };
  const bool any_scored = std::any_of(results.cells.begin(), results.cells.end(), is_scored);
  const std::vector<CellResult> cells = start_sequence_rows(
      table, results, [&](const CellResult& cell) { return is_scored(cell) || (any_scored && !cell.finished); });
  const Style percent{.decimals = 1, .percent = true};
  const Style coarse{.decimals = 1};
  append_columns<CellResult>(
      table, cells,
      {cell_column({"", "HOTA"}, percent, [](const CellResult& cell) { return cell.tracks.hota; }),
       cell_column({"", "MOTA"}, percent, [](const CellResult& cell) { return cell.tracks.mota; }),
       cell_column({"", "IDF1"}, percent, [](const CellResult& cell) { return cell.tracks.idf1; }),
       cell_column({"", "Switches per 100 s"}, {},
                   [](const CellResult& cell) { return cell.tracks.switches_per_100_s; }),
       cell_column({"", "False per 1,000 scans"}, coarse,
                   [](const CellResult& cell) { return cell.tracks.false_per_1000_scans; }),
       cell_column({"", "Along [m/s]"}, {}, [](const CellResult& cell) { return cell.tracks.along_mps; }),
       cell_column({"", "Across [m/s]"}, {}, [](const CellResult& cell) { return cell.tracks.across_mps; }),
       cell_column({"", "Heading [deg]"}, coarse, [](const CellResult& cell) { return cell.tracks.heading_deg; }),
       cell_column({"", "Centre [m]"}, {}, [](const CellResult& cell) { return cell.tracks.center_m; }),
       cell_column({"", "Size [m]"}, {}, [](const CellResult& cell) { return cell.tracks.size_m; }),
       cell_column({"", "Overlap"}, {}, [](const CellResult& cell) { return cell.tracks.overlap; }),
       cell_column({"", "NEES velocity"}, coarse, [](const CellResult& cell) { return cell.tracks.nees_velocity; }),
       cell_column({"", "NEES centre"}, coarse, [](const CellResult& cell) { return cell.tracks.nees_center; }),
       cell_column({"", "Latency [s]"}, {}, [](const CellResult& cell) { return cell.tracks.latency_s; })});
  return table;
}

std::vector<std::string> table_names() {
  return {kAccuracy, kConsistency, kRuntime, kAblation, kDynamics, kObjects, kTracks};
}

std::vector<Table> all_tables(const BenchmarkResults& results) {
  std::vector<Table> tables = {accuracy_table(results), consistency_table(results), runtime_table(results),
                               ablation_table(results), dynamics_table(results),    objects_table(results),
                               tracks_table(results)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace dynamic_icp::benchmark
