// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/results.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::benchmark {
namespace {

using Json = nlohmann::ordered_json;

Json cell_json(const CellResult& result) {
  Json json = {{"sequence", result.key.sequence},
               {"method", result.key.method},
               {"ablation", result.key.ablation},
               {"finished", result.finished},
               {"failure", result.failure},
               {"folder", result.folder.string()},
               {"jobs", result.jobs},
               {"processor", result.processor},
               {"frames", result.frames}};
  const auto write = [&](const char* key, const std::optional<double>& value) {
    json[key] = value ? Json(*value) : Json(nullptr);
  };
  for_each_number(result, write);
  for_each_track_number(result, write);
  json["notes"] = result.notes;
  json["warnings"] = result.warnings;
  return json;
}

CellResult cell_result(const Json& json) {
  CellResult result;
  result.key = {json.at("sequence").get<std::string>(), json.at("method").get<std::string>(),
                json.at("ablation").get<std::string>()};
  result.finished = json.at("finished").get<bool>();
  result.failure = json.at("failure").get<std::string>();
  result.folder = json.at("folder").get<std::string>();
  result.jobs = json.at("jobs").get<int>();
  result.processor = json.value("processor", "");
  result.frames = json.at("frames").get<std::size_t>();
  const auto read = [&](const char* key, std::optional<double>& value) {
    const Json& number = json.at(key);
    value = number.is_null() ? std::nullopt : std::optional(number.get<double>());
  };
  for_each_number(result, read);
  for_each_track_number(result, [&](const char* key, std::optional<double>& value) {
    if (json.contains(key)) {
      read(key, value);
    }
  });
  result.warnings = json.at("warnings").get<std::size_t>();
  result.notes = json.at("notes").get<std::vector<std::string>>();
  return result;
}

Json info_json(const BenchmarkInfo& info) {
  Json sequences = Json::array();
  for (const auto& [label, path] : info.sequences) {
    sequences.push_back({{"label", label}, {"path", path}});
  }
  return {{"version", info.version}, {"command", info.command}, {"machine", info.machine},   {"threads", info.threads},
          {"jobs", info.jobs},       {"preset", info.preset},   {"settings", info.settings}, {"sequences", sequences}};
}

BenchmarkInfo info_of(const Json& json) {
  BenchmarkInfo info;
  info.version = json.at("version").get<std::string>();
  info.command = json.at("command").get<std::string>();
  info.machine = json.at("machine").get<std::string>();
  info.threads = json.at("threads").get<int>();
  info.jobs = json.at("jobs").get<int>();
  info.preset = json.at("preset").get<std::string>();
  info.settings = json.at("settings").get<std::vector<std::string>>();
  for (const Json& sequence : json.at("sequences")) {
    info.sequences.emplace_back(sequence.at("label").get<std::string>(), sequence.at("path").get<std::string>());
  }
  return info;
}

/// Indented, with a line feed at the end; file names need not be UTF-8.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

template <class Read>
auto read_json(const std::string& text, const std::filesystem::path& origin, const char* what, const Read& read) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("{}: not the {} of a benchmark: {}", origin.string(), what, error.what()));
  }
}

}  // namespace

std::string to_json(const CellResult& result) { return text_of(cell_json(result)); }

CellResult cell_from_json(const std::string& text, const std::filesystem::path& origin) {
  return read_json(text, origin, "result of a cell", cell_result);
}

std::string to_json(const BenchmarkResults& results) {
  Json json = {{"info", info_json(results.info)}, {"cells", Json::array()}};
  for (const CellResult& cell : results.cells) {
    json["cells"].push_back(cell_json(cell));
  }
  return text_of(json);
}

BenchmarkResults results_from_json(const std::string& text, const std::filesystem::path& origin) {
  return read_json(text, origin, "results", [](const Json& json) {
    BenchmarkResults results;
    results.info = info_of(json.at("info"));
    for (const Json& cell : json.at("cells")) {
      results.cells.push_back(cell_result(cell));
    }
    return results;
  });
}

}  // namespace dynamic_icp::benchmark
