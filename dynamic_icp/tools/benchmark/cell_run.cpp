// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/cell_run.hpp"

#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/evaluation/object_error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kResultName = "cell.json";
constexpr const char* kMessagesName = "messages.txt";
constexpr std::size_t kLongestFailure = 1000;

Json read_json(const fs::path& path) {
  try {
    return Json::parse(formats::read_text_file(path));
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("{}: not a complete JSON document: {}", path.string(), error.what()));
  }
}

std::optional<double> number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? std::nullopt : std::optional(found->get<double>());
}

void read_summary(const fs::path& path, CellResult& result) {
  const Json summary = read_json(path);
  try {
    result.frames = summary.at("frames").get<std::size_t>();
    result.rte_rmse_m = number_in(summary, "rte_rmse_m");
    result.rre_rmse_deg = number_in(summary, "rre_rmse_deg");
    result.ate_rmse_m = number_in(summary, "ate_rmse_m");
    result.path_length_m = number_in(summary, "path_length_m");
    result.mean_iterations = number_in(summary, "mean_iterations");
    result.convergence_rate = number_in(summary, "convergence_rate");
    result.ms_mean = number_in(summary, "ms_mean");
    result.ms_median = number_in(summary, "ms_median");
    result.ms_p95 = number_in(summary, "ms_p95");
    result.fps = number_in(summary, "fps");
    result.dynamic_ratio_max = number_in(summary, "dynamic_ratio_max");
    result.dynamic_ratio_mean = number_in(summary, "dynamic_ratio_mean");
    result.clustered_ratio_mean = number_in(summary, "clustered_ratio_mean");
    result.refined_ratio_mean = number_in(summary, "refined_ratio_mean");
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("{}: not the summary of a run: {}", path.string(), error.what()));
  }
}

void read_notes(const fs::path& path, CellResult& result) {
  const Json run = read_json(path);
  for (const Json& assumption : run.value("assumptions", Json::array())) {
    result.notes.push_back(assumption.is_string() ? assumption.get<std::string>() : assumption.dump());
  }
  result.warnings = run.value("warnings", Json::array()).size();
}

ObjectScores score_objects(const fs::path& truth, const fs::path& reported) {
  const evaluation::ObjectError error =
      evaluation::compare_objects(evaluation::read_true_objects(truth), evaluation::read_reported_objects(reported));
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
    const Json saved = read_json(folder / kResultName);
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
