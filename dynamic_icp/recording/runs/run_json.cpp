// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_json.hpp"

#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/recording/datasets/followed_dataset.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json duration_json(const motion::SweepDuration& measured) {
  return {{"duration_s", measured.duration_s}, {"sigma_s", measured.sigma_s}};
}

Json search_json(const diagnosis::SweepSearch& search) {
  return {{"hypothesis", diagnosis::to_string(search.hypothesis)},
          {"margin_sigma", search.margin},
          {"azimuth_ccw", duration_json(search.by_azimuth)},
          {"as_stored", duration_json(search.as_stored)},
          {"scans", search.scans}};
}

Json sweep_json(const SweepRecord& sweep) {
  Json json = {{"times", sweep.times()}, {"duration_s", nullptr}, {"deskewed", sweep.deskewed()}};
  if (sweep.duration_s()) {
    json["duration_s"] = *sweep.duration_s();
  }
  if (sweep.search) {
    json["search"] = search_json(*sweep.search);
  }
  return json;
}

Json map_json(const RunSettings& settings, const RunResult& result, const fs::path& map_in_run) {
  if (!result.map_points) {
    return nullptr;
  }
  Json json = {{"path", fs::absolute(*settings.map_file).string()},
               {"file_in_run", nullptr},
               {"points", *result.map_points},
               {"voxel_size_m", settings.map_voxel_m}};
  if (!map_in_run.empty()) {
    json["file_in_run"] = map_in_run.generic_string();
  }
  return json;
}

/// A file beside the results of a run; null when it is not there.
Json file_json(bool is_there, const std::optional<fs::path>& path, const fs::path& in_run) {
  if (!is_there) {
    return nullptr;
  }
  Json json = {{"path", fs::absolute(*path).string()}, {"file_in_run", nullptr}};
  if (!in_run.empty()) {
    json["file_in_run"] = in_run.generic_string();
  }
  return json;
}

Json mcap_json(const RunSettings& settings, const RunResult& result, const FilesInRun& in_run) {
  Json json = file_json(result.has_mcap, settings.mcap_file, in_run.mcap);
  if (result.has_mcap && !in_run.layout.empty()) {
    json["layout_in_run"] = in_run.layout.generic_string();
  }
  return json;
}

Json input_json(const datasets::InputSettings& settings) {
  Json json = Json::object();
  for (const auto& [name, text] : datasets::texts(settings)) {
    json[name] = text;
  }
  return json;
}

Json configuration_json(odometry::Config config) {
  Json json;
  for (const ConfigField& field : odometry::fields(config)) {
    std::visit([&](const auto* value) { json[field.key] = *value; }, field.value);
  }
  return json;
}

Json path_json(const std::optional<fs::path>& path) {
  return path ? Json(fs::absolute(*path).string()) : Json(nullptr);
}

/// What was asked for, of what: the same whoever computes it, and wherever the results go.
Json request_json(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                  const fs::path& ground_truth) {
  return {{"version", version()},
          {"input",
           {{"path", recording.path == datasets::kStandardInput ? recording.path.string()
                                                                : fs::absolute(recording.path).string()},
            {"format", dataset.format()},
            {"options", input_json(recording.settings)},
            {"scans", dataset.size()}}},
          {"method", settings.method},
          {"preset", settings.preset},
          {"ablation", settings.ablation},
          {"start", settings.start},
          {"max_frames", settings.max_frames ? Json(*settings.max_frames) : Json(nullptr)},
          {"calibration", path_json(settings.calibration)},
          {"ground_truth", ground_truth.empty() ? Json(nullptr) : path_json(ground_truth)},
          {"configuration", configuration_json(settings.config)}};
}

/// File names need not be UTF-8.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string run_identity(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                         const fs::path& ground_truth) {
  Json json = request_json(recording, settings, dataset, ground_truth);
  json["save_labels"] = settings.save_labels;
  json["save_map"] = path_json(settings.map_file);
  json["map_voxel_m"] = settings.map_voxel_m;
  json["save_kitti"] = path_json(settings.kitti_file);
  return text_of(json, -1);
}

std::string run_json(const Recording& recording, const RunSettings& settings, const datasets::Dataset& dataset,
                     const fs::path& ground_truth, const RunResult& result, const FilesInRun& in_run) {
  Json json = request_json(recording, settings, dataset, ground_truth);
  json["command"] = settings.command;
  json["threads"] = settings.threads;
  json["stopped"] = result.summary.stopped;
  json["sweep"] = sweep_json(result.sweep);
  json["doppler"] = result.doppler;
  json["map"] = map_json(settings, result, in_run.map);
  json["mcap"] = mcap_json(settings, result, in_run);
  json["kitti"] = file_json(result.has_kitti, settings.kitti_file, in_run.kitti);
  json["assumptions"] = result.summary.assumptions;
  json["warnings"] = result.warnings;
  return text_of(json, 2) + "\n";
}

}  // namespace dynamic_icp::runs
