// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "benchmarks/sequence/measurement.hpp"
#include "benchmarks/sequence/timing.hpp"

namespace dynamic_icp::speed {

/// What the runs of one setup amount to. Each figure is the median over the runs.
struct Row {
  Setup setup;
  std::size_t runs = 0;
  std::size_t scans = 0;  ///< that count, of one run
  double points_mean = 0.0;
  double points_used_mean = 0.0;
  std::size_t lost = 0;  ///< the same in all runs
  Repeated p50_ms;       ///< and the least and largest of the runs: how quiet the machine was
  double p95_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
  double cpu_ms =
      0.0;  ///< processor time of all threads, mean of the scans: what else runs on the machine is not in it
  std::vector<double> warm_up_ms;
  std::map<std::string, double> stage_p50_ms;
  double peak_mib = 0.0;
  double work_mib = 0.0;           ///< the peak without the loaded scans
  std::optional<double> speed_up;  ///< p50 with one thread over p50; where one thread was measured
  std::optional<double> ratio;     ///< p50 over the reference work just before, where all runs have one
};

/// There must be at least one run.
Row summarise(const Setup& setup, const std::vector<Run>& runs);

/// Fills `speed_up`.
void compare(std::vector<Row>& rows);

/// How the time of a method grows with the points of a scan, over all recordings.
struct Growth {
  Setup setup;  ///< without recording
  double from_points = 0.0;
  double to_points = 0.0;
  double exponent = 0.0;
};

/// One for each method, preset and number of threads for which scans of different sizes were measured.
std::vector<Growth> growth_of(const std::vector<Row>& rows);

/// The last two parts of the path of a recording.
std::string short_name(const std::filesystem::path& recording);

std::string table_text(const std::vector<Row>& rows);
std::string stage_text(const std::vector<Row>& rows);
std::string growth_text(const std::vector<Growth>& growth);
nlohmann::ordered_json json_of(const std::vector<Row>& rows);
nlohmann::ordered_json json_of(const std::vector<Growth>& growth);

}  // namespace dynamic_icp::speed
