// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dynamic_icp::benchmark {

/// What is compared: one sequence through one method with one part of it switched off or none.
struct CellKey {
  std::string sequence;  ///< label of the input, unique in a benchmark
  std::string method;
  std::string ablation = "none";

  bool operator==(const CellKey&) const = default;
};

/// Velocities of moving objects against the truth (evaluation/object_error.hpp).
struct ObjectScores {
  std::optional<double> along_mae_mps;    ///< mean absolute error along the true motion
  std::optional<double> lateral_mae_mps;  ///< mean absolute error across it
  std::optional<double> median_relative_error;
  std::optional<double> estimated_share;  ///< of the true objects
  std::optional<double> false_per_scan;   ///< reported objects where there is none
};

/// Moving objects as tracks against the truth (evaluation/object_tracking.hpp); of methods that report boxes.
struct TrackScores {
  std::optional<double> hota;
  std::optional<double> mota;
  std::optional<double> idf1;
  std::optional<double> switches_per_100_s;
  std::optional<double> false_per_1000_scans;
  std::optional<double> along_mps;  ///< this and the next six: means over pairs
  std::optional<double> across_mps;
  std::optional<double> heading_deg;
  std::optional<double> center_m;
  std::optional<double> size_m;
  std::optional<double> overlap;
  std::optional<double> nees_velocity;
  std::optional<double> nees_center;
  std::optional<double> latency_s;  ///< median over bodies
};

/// The saved result of one cell. Numbers that do not exist (no ground truth, no objects) are absent.
struct CellResult {
  CellKey key;
  bool finished = false;
  std::string failure;           ///< what the program said, when it did not finish or most scans were lost
  std::filesystem::path folder;  ///< of the cell, relative to the benchmark's folder

  std::size_t frames = 0;
  std::optional<double> rte_rmse_m;
  std::optional<double> rre_rmse_deg;
  std::optional<double> ate_rmse_m;
  std::optional<double> path_length_m;
  std::optional<double> nees_rotation;  ///< of the stated covariances, see evaluation/consistency.hpp
  std::optional<double> nees_translation;
  std::optional<double> beyond_4_sigma;  ///< 0 to 1
  std::optional<double> mean_iterations;
  std::optional<double> convergence_rate;  ///< 0 to 1
  std::optional<double> ms_mean;
  std::optional<double> ms_median;
  std::optional<double> ms_p95;
  std::optional<double> fps;
  std::optional<double>
      peak_memory_mib;  ///< of the process that ran the cell, reading included; at least that of the benchmark itself
  std::optional<double> dynamic_ratio_max;
  std::optional<double> dynamic_ratio_mean;
  std::optional<double> clustered_ratio_mean;
  std::optional<double> refined_ratio_mean;
  ObjectScores objects;
  TrackScores tracks;
  std::vector<std::string> notes;  ///< what the run had to assume
  std::size_t warnings = 0;        ///< of the run; they are in its run.json
  int jobs = 1;                    ///< runs at the same time when this one was measured
  std::string processor;           ///< of the machine that ran it; empty: that of the benchmark
};

/// Calls visit(key, number) for each number of a result, those of summary.json by the keys they have there: one list
/// for writing and reading.
template <class Result, class Visit>
void for_each_number(Result& result, const Visit& visit) {
  visit("rte_rmse_m", result.rte_rmse_m);
  visit("rre_rmse_deg", result.rre_rmse_deg);
  visit("ate_rmse_m", result.ate_rmse_m);
  visit("path_length_m", result.path_length_m);
  visit("nees_rotation", result.nees_rotation);
  visit("nees_translation", result.nees_translation);
  visit("beyond_4_sigma", result.beyond_4_sigma);
  visit("mean_iterations", result.mean_iterations);
  visit("convergence_rate", result.convergence_rate);
  visit("ms_mean", result.ms_mean);
  visit("ms_median", result.ms_median);
  visit("ms_p95", result.ms_p95);
  visit("fps", result.fps);
  visit("peak_memory_mib", result.peak_memory_mib);
  visit("dynamic_ratio_max", result.dynamic_ratio_max);
  visit("dynamic_ratio_mean", result.dynamic_ratio_mean);
  visit("clustered_ratio_mean", result.clustered_ratio_mean);
  visit("refined_ratio_mean", result.refined_ratio_mean);
  visit("objects_along_mae_mps", result.objects.along_mae_mps);
  visit("objects_lateral_mae_mps", result.objects.lateral_mae_mps);
  visit("objects_median_relative_error", result.objects.median_relative_error);
  visit("objects_estimated_share", result.objects.estimated_share);
  visit("objects_false_per_scan", result.objects.false_per_scan);
}

/// The same for the numbers of tracks, which results of older versions do not have.
template <class Result, class Visit>
void for_each_track_number(Result& result, const Visit& visit) {
  visit("tracks_hota", result.tracks.hota);
  visit("tracks_mota", result.tracks.mota);
  visit("tracks_idf1", result.tracks.idf1);
  visit("tracks_id_switches_per_100_s", result.tracks.switches_per_100_s);
  visit("tracks_false_per_1000_scans", result.tracks.false_per_1000_scans);
  visit("tracks_along_mae_mps", result.tracks.along_mps);
  visit("tracks_across_mae_mps", result.tracks.across_mps);
  visit("tracks_heading_mae_deg", result.tracks.heading_deg);
  visit("tracks_center_mae_m", result.tracks.center_m);
  visit("tracks_size_mae_m", result.tracks.size_m);
  visit("tracks_overlap_mean", result.tracks.overlap);
  visit("tracks_nees_velocity", result.tracks.nees_velocity);
  visit("tracks_nees_center", result.tracks.nees_center);
  visit("tracks_latency_median_s", result.tracks.latency_s);
}

/// Where and with what the cells were run.
struct BenchmarkInfo {
  std::string version;
  std::string command;
  std::string machine;  ///< processor, number of processors, memory, operating system
  int threads = 0;      ///< of each run; 0: all processors
  int jobs = 1;         ///< runs at the same time
  std::string preset;
  std::vector<std::string> settings;                           ///< changes to the configuration, key=value
  std::vector<std::pair<std::string, std::string>> sequences;  ///< label and path of each input
};

/// Everything a table is made of.
struct BenchmarkResults {
  BenchmarkInfo info;
  std::vector<CellResult> cells;  ///< in the order of sequences, methods, ablations
};

/// Name of the file with the results in the folder of a benchmark.
inline constexpr const char* kResultsName = "results.json";

/// One cell as text and back, for the file beside its run. `cell_from_json` throws DataError naming `origin`.
std::string to_json(const CellResult& result);
CellResult cell_from_json(const std::string& text, const std::filesystem::path& origin);

/// results.json and back. `results_from_json` throws DataError naming `origin` and what is missing or wrong.
std::string to_json(const BenchmarkResults& results);
BenchmarkResults results_from_json(const std::string& text, const std::filesystem::path& origin);

}  // namespace dynamic_icp::benchmark
