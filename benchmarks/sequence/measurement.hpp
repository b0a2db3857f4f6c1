// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace dynamic_icp::speed {

/// The first scans of every run are not counted: caches are cold, the map is empty and the first pair is searched for.
inline constexpr std::size_t kWarmUpScans = 3;

/// What is timed.
struct Setup {
  std::filesystem::path recording;
  std::string method = "dynamic-icp";
  std::string preset = "default";
  int threads = 1;
};

/// One run over all scans of a recording.
struct Run {
  std::vector<double> warm_up_ms;              ///< each of the first scans
  std::vector<double> ms;                      ///< each of the others, from RawScan to Frame
  std::map<std::string, double> stage_p50_ms;  ///< median of each stage over the scans that count
  double cpu_ms_mean = 0.0;                    ///< processor time of all threads a scan, of the scans that count
  double points_mean = 0.0;                    ///< a scan as read, of the scans that count
  double points_used_mean = 0.0;               ///< after range crop and voxel grid
  std::size_t lost = 0;                        ///< scans, of those that count, with a pose that is only predicted
  double loaded_mib = 0.0;                     ///< resident when all scans were loaded and nothing was computed
  double peak_mib = 0.0;                       ///< most that was resident from then on
  std::optional<double> reference_ms;          ///< of the reference work just before; not measured by `measure`
};

/// Loads the recording and times every scan of it, reading excluded. Throws UsageError for unknown names and DataError
/// for recordings that cannot be read or have no more than `kWarmUpScans` scans.
Run measure(const Setup& setup);

/// The same in a child, so that `peak_mib` is the run's own.
Run measure_in_child(const Setup& setup);

void to_json(nlohmann::ordered_json& json, const Run& run);
void from_json(const nlohmann::ordered_json& json, Run& run);

}  // namespace dynamic_icp::speed
