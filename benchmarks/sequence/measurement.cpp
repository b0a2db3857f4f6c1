// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "benchmarks/sequence/measurement.hpp"

#include <array>
#include <chrono>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

#include "benchmarks/sequence/child_text.hpp"
#include "benchmarks/sequence/memory.hpp"
#include "benchmarks/sequence/timing.hpp"

namespace dynamic_icp::speed {
namespace {

using Clock = std::chrono::steady_clock;

struct Recording {
  std::vector<RawScan> scans;
  odometry::SensorContext surroundings;
};

Recording load(const std::filesystem::path& folder) {
  const auto dataset = datasets::open_dataset(folder);
  if (dataset->size() <= kWarmUpScans) {
    throw DataError(fmt::format("{}: has {} scans, expected more than the {} that are for warming up", folder.string(),
                                dataset->size(), kWarmUpScans));
  }
  Recording recording;
  recording.surroundings.T_vehicle_sensor = dataset->T_vehicle_sensor();
  for (std::size_t i = 0; i < dataset->size(); ++i) {
    recording.scans.push_back(dataset->scan(i));
  }
  return recording;
}

}  // namespace

Run measure(const Setup& setup) {
  const Recording recording = load(setup.recording);
  const auto odometry = odometry::make_odometry(odometry::configuration(setup.method, setup.preset),
                                                recording.surroundings, setup.threads);
  Run run;
  std::array<std::vector<double>, odometry::kStageCount> stages;
  const auto counted = static_cast<double>(recording.scans.size() - kWarmUpScans);
  restart_peak();
  run.loaded_mib = resident_mib();
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const std::clock_t cpu_begin = std::clock();
    const Clock::time_point begin = Clock::now();
    const odometry::Frame frame = odometry->process(recording.scans[i]);
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    const double cpu_ms = 1000.0 * static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    if (i < kWarmUpScans) {
      run.warm_up_ms.push_back(ms);
      continue;
    }
    run.ms.push_back(ms);
    run.cpu_ms_mean += cpu_ms / counted;
    run.points_mean += static_cast<double>(frame.points) / counted;
    run.points_used_mean += static_cast<double>(frame.points_used) / counted;
    run.lost += odometry::verdict(frame.status) == "lost" ? 1 : 0;
    for (std::size_t stage = 0; stage < stages.size(); ++stage) {
      stages[stage].push_back(frame.times.ms[stage]);
    }
  }
  run.peak_mib = peak_resident_mib();
  for (std::size_t stage = 0; stage < stages.size(); ++stage) {
    run.stage_p50_ms[std::string(to_string(static_cast<odometry::Stage>(stage)))] = median(stages[stage]);
  }
  return run;
}

Run measure_in_child(const Setup& setup) {
  const std::string text = text_of_child([&setup] { return nlohmann::ordered_json(measure(setup)).dump(); });
  return nlohmann::ordered_json::parse(text).get<Run>();
}

void to_json(nlohmann::ordered_json& json, const Run& run) {
  json = {{"warm_up_ms", run.warm_up_ms},
          {"ms", run.ms},
          {"stage_p50_ms", run.stage_p50_ms},
          {"cpu_ms_mean", run.cpu_ms_mean},
          {"points_mean", run.points_mean},
          {"points_used_mean", run.points_used_mean},
          {"lost", run.lost},
          {"loaded_mib", run.loaded_mib},
          {"peak_mib", run.peak_mib}};
}

void from_json(const nlohmann::ordered_json& json, Run& run) {
  json.at("warm_up_ms").get_to(run.warm_up_ms);
  json.at("ms").get_to(run.ms);
  json.at("stage_p50_ms").get_to(run.stage_p50_ms);
  json.at("cpu_ms_mean").get_to(run.cpu_ms_mean);
  json.at("points_mean").get_to(run.points_mean);
  json.at("points_used_mean").get_to(run.points_used_mean);
  json.at("lost").get_to(run.lost);
  json.at("loaded_mib").get_to(run.loaded_mib);
  json.at("peak_mib").get_to(run.peak_mib);
}

}  // namespace dynamic_icp::speed
