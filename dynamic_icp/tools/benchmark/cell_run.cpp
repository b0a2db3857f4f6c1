// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_run.hpp"

#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/frame_rows.hpp"
#include "dynamic_icp/recording/runs/run_values.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kResultName = "cell.json";
constexpr const char* kMessagesName = "messages.txt";
constexpr std::size_t kLongestFailure = 1000;

void read_summary(const fs::path& path, CellResult& result) {
  const runs::Settings summary = runs::read_summary(path);
  const auto frames = runs::number_of(summary, "frames");
  if (!frames) {
    throw DataError(fmt::format("{}: not the summary of a run: the number of frames is missing", path.string()));
  }
  result.frames = static_cast<std::size_t>(*frames);
  for_each_number(result, [&](const char* key, std::optional<double>& value) {
    if (const auto number = runs::number_of(summary, key)) {
      value = number;
    }
  });
}

void read_notes(const fs::path& path, CellResult& result) {
  runs::RunRecord record = runs::read_run_json(path);
  result.notes = std::move(record.assumptions);
  result.warnings = record.warnings.size();
}

std::vector<evaluation::ReportedObjects> reported_objects(const fs::path& path) {
  std::vector<evaluation::ReportedObjects> scans;
  for (const runs::ObjectsRow& row : runs::read_objects(path)) {
    evaluation::ReportedObjects& scan = scans.emplace_back();
    scan.index = static_cast<std::int64_t>(row.index);
    for (const runs::ObjectRow& object : row.objects) {
      scan.objects.push_back({object.velocity, object.centroid});
    }
  }
  return scans;
}

ObjectScores score_objects(const fs::path& truth, const fs::path& reported) {
  const evaluation::ObjectError error =
      evaluation::compare_objects(evaluation::read_true_objects(truth), reported_objects(reported));
  return {error.along_mae_mps, error.lateral_mae_mps, error.median_relative_error, error.estimated_share,
          error.false_per_scan};
}

/// The last things the run said, without the program's name.
std::string last_messages(const fs::path& path) {
  std::string text;
  try {
    text = formats::read_whole_file(path);
  } catch (const DataError&) {
    return {};
  }
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) {
    text.pop_back();
  }
  if (text.size() > kLongestFailure) {
    text = "..." + text.substr(text.size() - kLongestFailure);
  }
  const std::string name = "dynamic-icp: ";
  return text.starts_with(name) ? text.substr(name.size()) : text;
}

std::string failure_of(const EndedChild& child, const fs::path& messages) {
  const std::string said = last_messages(messages);
  const std::string ending = child.signal != 0
                                 ? fmt::format("killed by signal {} ({})", child.signal, ::strsignal(child.signal))
                                 : fmt::format("exit status {}", child.exit_status);
  return said.empty() ? ending : fmt::format("{}: {}", ending, said);
}

}  // namespace

std::optional<CellResult> saved_result(const fs::path& benchmark_folder, const CellPlan& plan) {
  const fs::path folder = benchmark_folder / plan.folder;
  std::error_code ignored;
  if (!fs::exists(folder / kResultName, ignored) || !fs::exists(folder / "run" / "summary.json", ignored)) {
    return std::nullopt;
  }
  try {
    const Json saved = formats::read_json_object(folder / kResultName);
    const CellResult result = cell_from_json(saved.at("result").dump(), folder / kResultName);
    const bool same = saved.at("fingerprint") == Json::parse(plan.fingerprint) && result.key == plan.key;
    return same && result.finished ? std::optional(result) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;  // of another version or damaged: as good as none
  }
}

pid_t start_cell(const fs::path& benchmark_folder, const fs::path& program, const CellPlan& plan) {
  const fs::path folder = benchmark_folder / plan.folder;
  formats::make_folder(folder);
  remove_partial_files(folder);
  std::error_code fault;
  fs::remove(folder / kResultName, fault);
  if (fault) {
    throw DataError(fmt::format("{}: cannot remove: {}", (folder / kResultName).string(), fault.message()));
  }
  std::vector<std::string> arguments = plan.arguments;
  for (const std::string& word :
       {std::string("--output"), (folder / "run").string(), std::string("--force"), std::string("--quiet")}) {
    arguments.push_back(word);
  }
  return start_child(program, arguments, folder / kMessagesName);
}

CellResult finish_cell(const fs::path& benchmark_folder, const CellPlan& plan, const EndedChild& child, int jobs) {
  const fs::path folder = benchmark_folder / plan.folder;
  CellResult result;
  result.key = plan.key;
  result.folder = plan.folder;
  result.jobs = jobs;
  result.peak_memory_mib = child.peak_memory_mib;
  if (!child.succeeded()) {
    result.failure = failure_of(child, folder / kMessagesName);
  } else {
    try {
      read_summary(folder / "run" / "summary.json", result);
      read_notes(folder / "run" / "run.json", result);
      if (!plan.object_truth.empty()) {
        result.objects = score_objects(plan.object_truth, folder / "run" / "objects.jsonl");
      }
      result.finished = true;
    } catch (const DataError& error) {
      result.failure = error.what();
    }
  }
  const Json saved = {{"fingerprint", Json::parse(plan.fingerprint)}, {"result", Json::parse(to_json(result))}};
  formats::write_whole_file(folder / kResultName, saved.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return result;
}

}  // namespace dynamic_icp::benchmark
