// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_plan.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace dynamic_icp::benchmark {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> run_arguments(const Sequence& sequence, const CellKey& key, const RunSettings& settings) {
  std::vector<std::string> arguments = {"run", sequence.path.string()};
  const auto add = [&](const std::string& option, const std::string& value) {
    arguments.push_back(option);
    arguments.push_back(value);
  };
  add("--method", key.method);
  add("--preset", settings.preset);
  add("--format", settings.input.open.format);
  for (const auto& [name, text] : datasets::texts(settings.input)) {
    const std::size_t dot = name.find('.');
    const std::string option = "--" + name.substr(0, dot);
    add(option, option == "--field" ? name.substr(dot + 1) + "=" + text : text);
  }
  add("--start", std::to_string(settings.start));
  add("--threads", std::to_string(settings.threads));
  if (key.ablation != "none") {
    add("--ablation", key.ablation);
  }
  for (const std::string& setting : settings.settings) {
    add("--set", setting);
  }
  if (settings.max_frames) {
    add("--max-frames", std::to_string(*settings.max_frames));
  }
  return arguments;
}

Json input_json(const Sequence& sequence) {
  return {{"path", sequence.path.string()},
          {"scans", sequence.scans},
          {"first_timestamp", format_seconds(sequence.first_stamp)},
          {"last_timestamp", format_seconds(sequence.last_stamp)},
          {"content", sequence.content}};
}

}  // namespace

CellPlan plan_cell(const Program& program, const Sequence& sequence, const std::string& method,
                   const std::string& ablation, const RunSettings& settings,
                   const std::vector<std::string>& configuration) {
  CellPlan plan;
  plan.key = {sequence.label, method, ablation};
  plan.folder = std::filesystem::path(sequence.label) / (ablation == "none" ? method : method + "_" + ablation);
  plan.arguments = run_arguments(sequence, plan.key, settings);
  plan.object_truth = sequence.object_truth;
  plan.scans = sequence.scans - std::min(settings.start, sequence.scans);
  plan.scans = std::min(plan.scans, settings.max_frames.value_or(plan.scans));
  plan.bytes_per_scan = sequence.bytes / std::max<std::size_t>(sequence.scans, 1);
  Json fingerprint = {{"version", program.version},
                      {"program", program.checksum},
                      {"processor", program.processor},
                      {"threads", settings.threads},
                      {"method", method},
                      {"ablation", ablation},
                      {"preset", settings.preset},
                      {"format", settings.input.open.format},
                      {"input_options", datasets::texts(settings.input)},
                      {"start", settings.start},
                      {"max_frames", settings.max_frames ? Json(*settings.max_frames) : Json(nullptr)},
                      {"input", input_json(sequence)},
                      {"configuration", configuration}};
  plan.fingerprint = fingerprint.dump(2, ' ', false, Json::error_handler_t::replace);
  return plan;
}

}  // namespace dynamic_icp::benchmark
